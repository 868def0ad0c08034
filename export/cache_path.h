#pragma once

#include <filesystem>
#include <string>

namespace toile::exports {

/// The file of a cache's path, which may name one of its meshes behind a #: run.abc#/skirt/skirtShape.
std::filesystem::path archive_of(const std::filesystem::path& cache);

/// What it names; empty: nothing.
std::string mesh_path_of(const std::filesystem::path& cache);

} // namespace toile::exports
