#include "research/benchmarks/paper/table1.h"

#include "research/benchmarks/paper/published.h"
#include "research/benchmarks/text_table.h"

namespace toile::research::paper {

namespace {

constexpr int kDimensions = 3;

const Row kColumns{"scene",           "method",       "bodies",      "DOF",
                   "iterations",      "PCG",          "cull ms",     "narrow ms",
                   "LG ms",           "step ms",      "prepare s",   "GPU GB",
                   "at limit",        "crossings",    "paper DOF",   "paper iterations",
                   "paper cull ms",   "paper narrow", "paper LG ms", "paper step ms",
                   "... times bodies"};

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
              std::to_string(run.crossings)};
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

} // namespace

std::vector<TableRow> measure_table1(const CudaSpace& space, const std::filesystem::path& scene, int frames)
{
    const std::string name = scene.stem().string();
    gpu::SceneCase what;
    what.name = name;
    what.file = scene;
    what.frames = frames;
    what.keeps_solver = true;
    std::vector<TableRow> rows;
    for (gpu::SceneRun& run : gpu::measure_scene(space, what))
        rows.push_back({name, "to the error", std::move(run)});
    what.keeps_solver = false;
    what.stop = StepStop::Move;
    if (const Published* const theirs = published(name))
        what.move = theirs->move;
    for (gpu::SceneRun& run : gpu::measure_scene(space, what))
        rows.push_back({name, "quadrature, by move", std::move(run)});
    return rows;
}

std::string markdown_of(const std::vector<TableRow>& rows)
{
    return markdown(kColumns, rows_of(rows, row_of));
}

std::string csv_of(const std::vector<TableRow>& rows) { return csv(kColumns, rows_of(rows, row_of)); }

} // namespace toile::research::paper
