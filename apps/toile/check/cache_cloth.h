#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "export/point_cache.h"
#include "scenes/format/scene.h"

namespace toile::app {

/// A cloth or solid in a cache.
struct ClothInCache {
    std::filesystem::path file; ///< may name a mesh behind #
    scene::Export entry;        ///< how it was written; of the scene if it exports this file
    int surface;                ///< index in World::surfaces()
};

/// Cloths and solids that a cache holds: the one named; else those exported to a file of this name; else
/// those that the file or its meshes are named after; else the only one.
/// @param unlisted  keys of a cache that the scene does not export
/// @throws InvalidInput if this is ambiguous or the named cloth does not exist, and as read_cache()
std::vector<ClothInCache> cloths_of_cache(const scenes::Scene& scene, const std::filesystem::path& cache,
                                          const std::string& named, const scene::Export& unlisted = {});

/// @throws InvalidInput unless the cache has as many points as the cloth.
void require_same_points(const exports::PointCache& cache, const std::filesystem::path& file,
                         const std::string& cloth, int vertex_count);

/// @throws InvalidInput unless the cache, where it knows its times, has one frame for each of the scene: all,
/// or the first ones.
void require_same_times(const exports::PointCache& cache, const std::filesystem::path& file, double fps,
                        int frame_count);

} // namespace toile::app
