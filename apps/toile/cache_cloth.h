#pragma once

#include <filesystem>
#include <string>

#include "export/point_cache.h"
#include "scenes/world.h"

namespace toile {

/// Which cloth or solid of a scene a cache holds: the one named, else the one that the scene exports to a
/// file of this name, else the one whose name the file carries, else the only one.
/// @return index in World::surfaces()
/// @throws InvalidInput when that leaves a choice or the named cloth does not exist.
int cloth_of_cache(const Scene& scene, const std::filesystem::path& cache, const std::string& named);

/// @throws InvalidInput unless the cache has as many points as the cloth.
void require_same_points(const PointCache& cache, const std::filesystem::path& file, const std::string& cloth,
                         int vertex_count);

} // namespace toile
