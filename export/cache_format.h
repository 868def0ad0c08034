#pragma once

#include <filesystem>

namespace toile::exports {

enum class CacheFormat { Pc2, Mdd, Obj };

/// Format for the extension of `file`: .pc2, .mdd or .obj.
/// @throws InvalidInput for any other.
CacheFormat cache_format(const std::filesystem::path& file);

} // namespace toile::exports
