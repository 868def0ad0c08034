#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "export/point_cache.h"

namespace toile::exports {

/// Paths of the meshes of a USD file.
/// @throws InvalidInput as open_usd()
std::vector<std::string> usd_mesh_paths(const std::filesystem::path& stage);

/// Opens a mesh of a .usda, .usdc or .usd with its faces, by the file's path and that of the mesh in it:
/// run.usda#/skirt/skirtShape. Without the second it is the only mesh. Value clips are played, and transforms
/// above the mesh applied. Python with USD copies the frames into a file without a name first, in the folder
/// for temporary files: 12 bytes a point and frame.
/// @throws InvalidInput naming the file, the prim, the fault and a remedy: one of them is a mesh whose faces
///         change, another that there is no Python with USD
std::unique_ptr<const PointCache::Source> open_usd(const std::filesystem::path& file);

} // namespace toile::exports
