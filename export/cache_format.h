#pragma once

#include <filesystem>

namespace toile {

enum class CacheFormat { Pc2, Mdd, Obj };

/// The format that the extension of `file` names: .pc2, .mdd or .obj.
/// @throws InvalidInput for any other.
CacheFormat cache_format(const std::filesystem::path& file);

} // namespace toile
