#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "export/axes.h"

namespace toile::exports {

enum class PlyType { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

/// Bytes of a value in a binary file.
int size_of(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::Float32;
    std::optional<PlyType> count_type; ///< of a list: an integer
};

struct PlyElement {
    std::string name;
    std::int64_t count = 0;
    std::vector<PlyProperty> properties;

    /// Index of the first property with one of these names, -1 if there is none.
    int find(const std::vector<std::string>& names, bool is_list) const;
};

/// Beginning of a PLY file: what its values are, element by element.
struct PlyHeader {
    enum class Encoding { Ascii, LittleEndian, BigEndian };

    Encoding encoding = Encoding::Ascii;
    std::vector<PlyElement> elements;
    std::optional<Axes> axes; ///< of a file with a line axes_comment()
    std::size_t size = 0;     ///< [bytes] the values follow
};

/// Line of a header that says what the positions are: comment toile, unit cm, up z.
std::string axes_comment(const Axes& axes);

/// @param file  for errors
/// @throws InvalidInput naming the file, the line and what it should say
PlyHeader read_ply_header(const std::filesystem::path& file, std::string_view bytes);

} // namespace toile::exports
