#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "export/alembic/ogawa_file.h"

namespace toile::exports {

/// Elements of a property of an Alembic archive. The values are those of the file format.
enum class AbcType : std::uint8_t { Byte = 1, Uint32 = 5, Int32 = 6, Float32 = 10, Float64 = 11 };

/// A property of an Alembic archive with its samples: one value, or an array of them. With one sample it is
/// constant; all samples of one property have the same number of elements [Alembic 1.8,
/// lib/Alembic/AbcCoreOgawa].
class AbcProperty {
public:
    enum class Kind { Scalar = 1, Array = 2 };
    struct Layout {
        std::string name;
        Kind kind;
        AbcType type;
        int extent; ///< numbers per value
        std::string metadata = {};
        int time_sampling = 0; ///< 0: none
    };
    explicit AbcProperty(Layout layout) : layout_(std::move(layout)) {}

    /// Appends a sample. Data equal to that of the last sample is not repeated.
    /// @param bytes  the values, little endian
    void add_sample(OgawaFile& file, std::string_view bytes);

    bool is_empty() const { return samples_.empty(); }
    OgawaNode add_group(OgawaFile& file) const;
    std::string header() const; ///< entry in the list of its compound

private:
    bool is_constant() const { return samples_.size() <= 1; }

    Layout layout_;
    std::vector<OgawaNode> samples_; ///< data of each
    std::string last_digest_;
};

/// Compound of properties.
struct AbcCompound {
    std::string name, metadata;
    std::vector<const AbcProperty*> properties = {};
    std::vector<AbcCompound> compounds = {};

    OgawaNode add_group(OgawaFile& file) const;
    std::string header() const;
};

} // namespace toile::exports
