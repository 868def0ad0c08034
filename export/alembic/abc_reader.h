#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "export/alembic/abc_property.h"
#include "export/alembic/ogawa_reader.h"

namespace toile::exports {

/// A property of an archive that is read.
struct AbcReadProperty {
    std::string name, metadata;
    bool is_compound = false;
    AbcProperty::Kind kind = AbcProperty::Kind::Array;
    int type = 0;   ///< AbcType, or another one of the format
    int extent = 0; ///< numbers per value
    int samples = 0;
    int first_changed = 0, last_changed = 0;
    int time_sampling = 0;
    OgawaNode group = kOgawaNothing;
    std::vector<OgawaNode> nodes; ///< of the group, if it is no compound
};

/// An object of an archive that is read.
struct AbcReadObject {
    std::string name, metadata;
    int parent = -1; ///< in AbcReader::objects()
    OgawaNode properties = kOgawaNothing;

    bool is(const std::string& type) const; ///< of a schema, such as PolyMesh
};

/// Objects and properties of an Alembic archive, of our own or of other programs.
class AbcReader {
public:
    /// @throws InvalidInput naming file and byte
    explicit AbcReader(const std::filesystem::path& file);

    const std::vector<AbcReadObject>& objects() const { return objects_; } ///< parents first
    /// Names of all objects above one and its own, each after a slash.
    std::string path_of(int object) const;
    /// Times of the samples of an object's property. [samples] [s]
    /// @throws InvalidInput for times that do not increase
    std::vector<double> times_of(const AbcReadProperty& property, int object) const;
    /// Rate that the archive's metadata names; samples may be at another one.
    std::optional<double> frames_per_second() const;
    /// Value of a key of the archive's metadata; empty: none.
    std::string value_of(const std::string& key) const;

    std::vector<AbcReadProperty> properties(OgawaNode compound) const;

    /// A property by the names of its compounds and its own; empty if there is none.
    std::optional<AbcReadProperty> find(OgawaNode compound, const std::vector<std::string>& names) const;

    /// Bytes of a sample: all values, little endian.
    /// @param index  [0, samples)
    std::string sample(const AbcReadProperty& property, int index) const;

    /// Refuses the file, naming an object.
    [[noreturn]] void refuse(int object, const std::string& why) const;
    const std::filesystem::path& path() const { return file_.path(); }

private:
    /// Times that repeat.
    struct Cycle {
        double duration = 1.0;      ///< [s]
        std::vector<double> starts; ///< [samples of the first cycle] [s]
    };
    void read_times(OgawaNode node);
    void read_metadata(OgawaNode node);
    void read_objects(OgawaNode group, int parent, int depth);

    OgawaReader file_;
    std::vector<std::string> metadata_; ///< by the numbers in headers
    std::vector<Cycle> times_;          ///< by AbcReadProperty::time_sampling
    std::string archive_metadata_;      ///< key=value;key=value
    std::vector<AbcReadObject> objects_;
    std::set<OgawaNode> read_; ///< groups of objects_ and lists of their names
};

} // namespace toile::exports
