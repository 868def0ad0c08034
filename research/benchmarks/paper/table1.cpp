#include "research/benchmarks/paper/table1.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "research/benchmarks/paper/published.h"
#include "research/benchmarks/text_table.h"

namespace toile::research::paper {

namespace {

constexpr int kDimensions = 3;

const Row kColumns{"scene",         "method",           "bodies",        "DOF",          "iterations",
                   "PCG",           "cull ms",          "narrow ms",     "LG ms",        "step ms",
                   "prepare s",     "GPU GB",           "at limit",      "crossings",    "error mm",
                   "paper DOF",     "paper iterations", "paper cull ms", "paper narrow", "paper LG ms",
                   "paper step ms", "... times bodies"};

std::string in_thousands(double dofs) { return format("%.0fK", 1e-3 * dofs); }

Row row_of(const TableRow& row)
{
    const gpu::SceneRun& run = row.run;
    Row cells{row.scene,
              row.method,
              std::to_string(run.bodies),
              in_thousands(double(kDimensions) * run.vertices),
              format("%.1f", run.iterations),
              format("%.0f", run.linear_iterations),
              format("%.1f", run.cull_ms),
              format("%.1f", run.narrow_ms),
              format("%.1f", run.minimise_ms),
              format("%.1f", run.total_ms),
              format("%.1f", run.prepare_s),
              format("%.2f", run.device_gb),
              std::to_string(run.frames_at_limit),
              std::to_string(run.crossings),
              std::isnan(row.error) ? "" : format("%.2g", 1e3 * row.error)};
    const Published* const theirs = published(row.scene);
    if (theirs == nullptr) {
        cells.resize(kColumns.size());
        return cells;
    }
    for (const std::string& cell :
         {in_thousands(theirs->dofs), format("%.0f", theirs->iterations), format("%.1f", theirs->cull_ms),
          format("%.1f", theirs->narrow_ms), format("%.0f", theirs->local_global_ms),
          format("%.0f", theirs->total_ms), format("%.0f", theirs->total_ms * run.bodies)})
        cells.push_back(cell);
    return cells;
}

std::string name_of(TableMethod method)
{
    switch (method) {
    case TableMethod::Converged:
        return "converged";
    case TableMethod::ToTheError:
        return "to the error";
    case TableMethod::QuadratureByMove:
        return "quadrature, by move";
    default:
        return "A-Jacobi, by move";
    }
}

/// Tolerance of TableMethod::Converged [m/s]: the default's is 1e-2.
constexpr double kConvergedTolerance = 1e-4;

/// RMS distance of vertices; NaN if there is nothing to compare.
double distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    if (a.size() != b.size() || a.empty())
        return std::numeric_limits<double>::quiet_NaN();
    double sum = 0.0;
    for (size_t i = 0; i < a.size(); ++i)
        sum += (a[i] - b[i]).squaredNorm();
    return std::sqrt(sum / double(a.size()));
}

} // namespace

TableRow measure_row(const CudaSpace& space, const std::filesystem::path& scene, TableMethod method,
                     int frames)
{
    gpu::SceneCase what;
    what.name = scene.stem().string();
    what.file = scene;
    what.frames = frames;
    what.sample_frame = kSampleFrame;
    what.keeps_solver = method == TableMethod::Converged || method == TableMethod::ToTheError;
    if (method == TableMethod::JacobiByMove)
        what.method = scene::SolverMethod::AJacobi;
    if (method == TableMethod::Converged) {
        what.frames = std::min(frames, kSampleFrame);
        what.velocity_tolerance = kConvergedTolerance;
    }
    if (!what.keeps_solver) {
        what.stop = StepStop::Move;
        if (const Published* const theirs = published(what.name))
            what.move = theirs->move;
    }
    return {what.name, name_of(method), gpu::measure_scene(space, what).back()};
}

bool measure_table1(const std::vector<std::filesystem::path>& scenes, const TableCalls& calls)
{
    std::vector<TableRow> rows;
    bool has_failed = false;
    const auto report = [&](const std::string& error) {
        has_failed = true;
        calls.failed(error);
    };
    for (const std::filesystem::path& scene : scenes) {
        bool works = true;
        std::vector<Vec3> converged;
        for (const TableMethod method : {TableMethod::Converged, TableMethod::ToTheError,
                                         TableMethod::QuadratureByMove, TableMethod::JacobiByMove}) {
            if (!works || !calls.goes_on() || (method == TableMethod::Converged && !calls.has_sample))
                continue;
            try {
                TableRow row = calls.measure(scene, method);
                if (method == TableMethod::Converged) {
                    converged = row.run.sample;
                    continue;
                }
                row.error = distance(row.run.sample, converged);
                rows.push_back(std::move(row));
                calls.finished(rows);
            } catch (const InvalidInput& error) { // names the scene's file
                works = false;
                report(error.what());
            } catch (const std::exception& error) {
                report(scene.string() + ", " + name_of(method) + ": " + error.what());
            }
        }
    }
    return !has_failed;
}

std::string markdown_of(const std::vector<TableRow>& rows)
{
    return markdown(kColumns, rows_of(rows, row_of));
}

std::string csv_of(const std::vector<TableRow>& rows) { return csv(kColumns, rows_of(rows, row_of)); }

std::string markdown_header() { return markdown(kColumns, {}); }

std::string markdown_of(const TableRow& row) { return markdown_row(kColumns, row_of(row)); }

} // namespace toile::research::paper
