#pragma once

#include <filesystem>
#include <vector>

#include "scenes/format/scene.h"

namespace toile::app {

/// A scene and its output paths.
struct SceneJob {
    scenes::Scene scene;
    std::filesystem::path folder; ///< of caches and certificate
    std::filesystem::path report; ///< empty: none
};

/// A file that a scene exports.
struct ExportFile {
    std::filesystem::path file;
    scene::Export entry;
};

/// Caches that the scene exports.
std::vector<ExportFile> caches_of(const SceneJob& job);

/// Meshes that PC2 and MDD caches play on, in their start pose: an OBJ of the same name beside each. None
/// where an OBJ of that name is itself a cache with the same contents.
std::vector<ExportFile> start_meshes_of(const SceneJob& job);

/// Folders that caches and certificate are written to, each once.
std::vector<std::filesystem::path> output_folders_of(const SceneJob& job);

/// Certificates that may lie beside the caches from earlier runs and checks: of all, and of each alone.
std::vector<std::filesystem::path> certificates_of(const SceneJob& job);

/// Refuses exports of a cloth none of which could be checked after the run: those for other programs, and USD
/// without Python that reads it.
/// @throws InvalidInput
void require_checkable(const SceneJob& job);

/// Refuses, without changing a file, jobs that would write a file that one of them reads, or one file twice;
/// folders that another run is writing to; and reports that could not be written.
/// @throws InvalidInput naming both files and their roles
void require_safe_outputs(const std::vector<SceneJob>& jobs);

} // namespace toile::app
