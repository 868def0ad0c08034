#pragma once

#include <filesystem>
#include <string>

#include "export/cache_layout.h"

namespace toile::exports {

/// The file of a cache's path, which may name one of its meshes behind a #: run.abc#/skirt/skirtShape.
std::filesystem::path archive_of(const std::filesystem::path& cache);

/// Path that a mesh gets in an archive, or its end: /skirt/skirtShape, or /tee/front/frontShape with a
/// parent.
std::string path_of_mesh(const CacheMesh& mesh);

/// What it names; empty: nothing.
std::string mesh_path_of(const std::filesystem::path& cache);

} // namespace toile::exports
