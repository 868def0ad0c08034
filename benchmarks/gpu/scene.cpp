#include "benchmarks/gpu/scene.h"

#include <chrono>
#include <initializer_list>
#include <string_view>

#include "benchmarks/text_table.h"
#include "scenes/format/read_scene.h"
#include "scenes/world_crossings.h"

namespace toile::gpu {

namespace {

double seconds_of(const Stages& stages, std::initializer_list<std::string_view> names)
{
    double sum = 0.0;
    for (const std::string_view name : names)
        sum += stages.seconds(name);
    return sum;
}

SceneRun run_on(Backend backend, const SceneCase& what)
{
    Scene scene = read_scene(what.file);
    scene.solver.method = scene::SolverMethod::Quadrature;
    WorldOptions options;
    options.backend = backend;
    World world(scene, options);
    world.prepare();
    world.settle();

    SceneRun run;
    run.name = what.name;
    run.backend = backend == Backend::Cuda ? "cuda" : "cpu";
    for (const ClothState& cloth : world.cloths())
        run.vertices += int(cloth.positions.size());
    const Stages before = world.stages();
    const auto start = std::chrono::steady_clock::now();
    for (int frame = 0; frame < what.frames; ++frame) {
        const StepReport report = world.advance_frame();
        run.steps += report.steps;
        run.iterations += report.iterations;
        run.linear_iterations += report.linear_iterations;
        run.contacts = report.contacts;
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    run.crossings = crossing_count(world);

    const double ms = 1e3 / run.steps;
    const auto of_step = [&](std::initializer_list<std::string_view> names) {
        return ms * (seconds_of(world.stages(), names) - seconds_of(before, names));
    };
    run.total_ms = ms * seconds;
    run.search_ms = of_step({"collision/near_pairs", "collision/detect"});
    run.apart_ms = of_step({"collision/safe_step"});
    run.minimise_ms = of_step({"pd/descend"});
    run.limit_ms = of_step({"pd/limits"});
    run.iterations /= run.steps;
    run.linear_iterations /= run.steps;
    return run;
}

std::vector<Row> rows_of(const std::vector<SceneRun>& runs)
{
    std::vector<Row> rows;
    rows.reserve(runs.size());
    for (const SceneRun& r : runs)
        rows.push_back({r.name, r.backend, std::to_string(r.vertices), std::to_string(r.steps),
                        format("%.0f", r.iterations), format("%.0f", r.linear_iterations),
                        std::to_string(r.contacts), std::to_string(r.crossings), format("%.1f", r.search_ms),
                        format("%.1f", r.minimise_ms), format("%.1f", r.apart_ms), format("%.1f", r.limit_ms),
                        format("%.1f", r.total_ms)});
    return rows;
}

} // namespace

std::vector<SceneRun> measure_scene(const SceneCase& what)
{
    std::vector<SceneRun> runs;
    if (what.on_cpu)
        runs.push_back(run_on(Backend::Cpu, what));
    runs.push_back(run_on(Backend::Cuda, what));
    return runs;
}

std::string markdown_of(const std::vector<SceneRun>& runs)
{
    return markdown({"scene", "backend", "vertices", "steps", "iterations", "PCG", "contacts", "crossings",
                     "search ms", "minimise ms", "apart ms", "limits ms", "step ms"},
                    rows_of(runs));
}

std::string csv_of(const std::vector<SceneRun>& runs)
{
    return csv({"scene", "backend", "vertices", "steps", "iterations", "pcg", "contacts", "crossings",
                "search_ms", "minimise_ms", "apart_ms", "limits_ms", "step_ms"},
               rows_of(runs));
}

} // namespace toile::gpu
