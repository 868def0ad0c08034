#pragma once

#include <string>
#include <vector>

#include "research/benchmarks/gpu/scene.h"

namespace toile::research::paper {

/// A scene of the paper's Table 1 on a GPU, by one method.
struct TableRow {
    std::string scene, method;
    gpu::SceneRun run;
};

/// Runs a scene by its own method, to the default error of a step, and by L-BFGS with quadrature until
/// positions move as little as in the paper.
/// @param frames  after the start pose
std::vector<TableRow> measure_table1(const CudaSpace& space, const std::filesystem::path& scene, int frames);

/// Ours beside the paper's.
std::string markdown_of(const std::vector<TableRow>& rows);
std::string csv_of(const std::vector<TableRow>& rows);

} // namespace toile::research::paper
