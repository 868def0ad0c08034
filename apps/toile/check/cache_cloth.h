#pragma once

#include <filesystem>
#include <string>

#include "export/point_cache.h"
#include "scenes/format/scene.h"

namespace toile::app {

/// Cloth or solid that a cache belongs to: the one named; else the one exported to a file of this name; else
/// the one named like the file; else the only one.
/// @return index in World::surfaces()
/// @throws InvalidInput if this is ambiguous or the named cloth does not exist.
int cloth_of_cache(const scenes::Scene& scene, const std::filesystem::path& cache, const std::string& named);

/// @throws InvalidInput unless the cache has as many points as the cloth.
void require_same_points(const exports::PointCache& cache, const std::filesystem::path& file,
                         const std::string& cloth, int vertex_count);

/// @throws InvalidInput unless the cache, where it knows its times, has one frame for each of the scene from
/// the first on.
void require_same_times(const exports::PointCache& cache, const std::filesystem::path& file, double fps);

} // namespace toile::app
