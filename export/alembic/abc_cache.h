#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "export/point_cache.h"

namespace toile::exports {

/// Paths of the meshes of an archive.
/// @throws InvalidInput as open_abc()
std::vector<std::string> abc_mesh_paths(const std::filesystem::path& archive);

/// Opens a mesh of an Alembic archive with its faces, by the archive's path and that of the mesh in it:
/// run.abc#/skirt/skirtShape. Without the second it is the only mesh. Transforms above it are applied.
/// @throws InvalidInput naming the file, the byte or the object, the fault and a remedy: one of them is a
///         mesh whose faces change
std::unique_ptr<const PointCache::Source> open_abc(const std::filesystem::path& file);

} // namespace toile::exports
