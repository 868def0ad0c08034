#pragma once

#include <filesystem>

namespace toile::exports {

enum class CacheFormat { Pc2, Mdd, Abc, Usd, Obj };

/// Format for the extension of `file`: .pc2, .mdd, .abc, .usda, .usdc, .usd or .obj. A mesh in an
/// archive may follow: run.abc#/skirt/skirtShape.
/// @throws InvalidInput for any other.
CacheFormat cache_format(const std::filesystem::path& file);

/// Whether caches of a format hold the faces that they play on.
bool stores_faces(CacheFormat format);

/// Whether they hold any number of meshes.
bool holds_several_meshes(CacheFormat format);

} // namespace toile::exports
