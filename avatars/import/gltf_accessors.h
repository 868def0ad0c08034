#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "avatars/import/gltf_file.h"

namespace toile::avatars {

/// Set of accessor component types, one bit each. The order is glTF's, from 5120 on; 5124 is none.
enum ComponentTypes : unsigned {
    kByte = 1u << 0,
    kUnsignedByte = 1u << 1,
    kShort = 1u << 2,
    kUnsignedShort = 1u << 3,
    kUnsignedInt = 1u << 5,
    kFloat = 1u << 6,
};

/// What glTF allows at a place that names an accessor.
struct AccessorRule {
    std::string_view type;    ///< "SCALAR", "VEC2", "VEC3", "VEC4" or "MAT4"
    unsigned component_types; ///< of ComponentTypes
};

/// Elements of an accessor as real numbers; normalised integers are scaled to [0, 1] or [-1, 1].
struct Elements {
    int count = 0;
    int width = 0;              ///< numbers per element
    std::vector<double> values; ///< [count * width] finite

    const double* operator[](int i) const { return values.data() + size_t(i) * size_t(width); }
};

/// Reads accessors. Every range is checked before its bytes are touched.      [glTF 2.0, section 3.6.2]
class GltfAccessors {
public:
    explicit GltfAccessors(GltfFile& file) : file_(file) {}

    /// @param reference  index of the accessor, at the place where the file uses it
    /// @throws InvalidInput naming the property of the accessor or its view that is wrong, and the first
    ///         element that is not finite. See GltfFile::spend().
    Elements read(const GltfValue& reference, const AccessorRule& rule);

    /// As above, of exactly `count` elements.
    Elements read(const GltfValue& reference, const AccessorRule& rule, int count);

private:
    /// Place of elements in a buffer.
    struct Range {
        Bytes bytes;
        size_t stride = 0;
    };

    Range range(const GltfValue& owner, const GltfValue& count, size_t element_size);
    void replace_sparse(const GltfValue& accessor, unsigned component_type, bool normalised,
                        Elements& elements);

    GltfFile& file_;
};

} // namespace toile::avatars
