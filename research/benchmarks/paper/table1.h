#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "research/benchmarks/gpu/scene.h"

namespace toile::research::paper {

/// How steps are minimised and when they end.
enum class TableMethod {
    Converged,        ///< the scene's own method, to a hundredth of the default error of a step
    ToTheError,       ///< the scene's own method, to the default error of a step
    QuadratureByMove, ///< L-BFGS with quadrature, until positions move as little as in the paper
    JacobiByMove,     ///< the same without quadrature: with A-Jacobi
};

/// A scene of the paper's Table 1 on a GPU, by one method.
struct TableRow {
    std::string scene, method;
    gpu::SceneRun run;
    double error = 0.0; ///< [m] RMS distance of SceneRun::sample to that of TableMethod::Converged; NaN: none
};

/// Frame whose positions are compared, and the last of TableMethod::Converged.
inline constexpr int kSampleFrame = 8;

/// Runs a scene by a method.
/// @param frames  after the start pose
/// @throws InvalidInput for a scene that does not work, DeviceError if the GPU lacks memory or fails
TableRow measure_row(const CudaSpace& space, const std::filesystem::path& scene, TableMethod method,
                     int frames);

/// Callbacks of measure_table1().
struct TableCalls {
    std::function<TableRow(const std::filesystem::path& scene, TableMethod method)> measure; ///< may throw
    std::function<void(const std::vector<TableRow>& rows)> finished; ///< all so far, after each row
    std::function<void(const std::string& error)> failed;            ///< names scene and method
    std::function<bool()> goes_on;                                   ///< asked before each row
    bool has_sample = true; ///< the runs reach kSampleFrame; false: no errors
};

/// Measures scenes by all methods, which have a row each but TableMethod::Converged. Where a row fails, the
/// next one follows; a scene that does not work has no other row.
/// @return whether no row failed
bool measure_table1(const std::vector<std::filesystem::path>& scenes, const TableCalls& calls);

/// Ours beside the paper's.
std::string markdown_of(const std::vector<TableRow>& rows);
std::string csv_of(const std::vector<TableRow>& rows);

/// Parts of such a table, for rows that are printed as they finish: not aligned.
std::string markdown_header();
std::string markdown_of(const TableRow& row);

} // namespace toile::research::paper
