#include "research/benchmarks/gpu/scene.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <string_view>

#include "core/base/error.h"
#include "research/benchmarks/text_table.h"
#include "research/scenes/literature_methods.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"
#include "scenes/world/world_crossings.h"

namespace toile::research::gpu {

namespace {

constexpr double kGiga = 1e9;

template <typename Work>
double seconds_of(const Work& work)
{
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double sum_of(const Stages& stages, std::initializer_list<std::string_view> names)
{
    double sum = 0.0;
    for (const std::string_view name : names)
        sum += stages.seconds(name);
    return sum;
}

/// Sums up frames, starting from a given state of the stages.
class Tally {
public:
    Tally(SceneRun start, const Stages& stages) : sum_(std::move(start)), before_(stages) {}

    void add(const StepReport& report, double seconds)
    {
        ++sum_.frames;
        sum_.steps += report.steps;
        sum_.iterations += report.iterations;
        sum_.linear_iterations += report.linear_iterations;
        sum_.contacts += report.contacts;
        sum_.frames_at_limit += report.status == StepReport::Status::IterationLimit;
        sum_.max_strain = std::max(sum_.max_strain, report.max_strain);
        sum_.slowest_ms = std::max(sum_.slowest_ms, 1e3 * seconds / report.steps);
        seconds_ += seconds;
    }

    SceneRun so_far(const Stages& stages) const
    {
        SceneRun run = sum_;
        const double ms = 1e3 / run.steps;
        const auto of_step = [&](std::initializer_list<std::string_view> names) {
            return ms * (sum_of(stages, names) - sum_of(before_, names));
        };
        // On a GPU the search includes the test which pairs press; on the CPU it is part of making terms.
        const double pressing_ms = run.backend == "cuda" ? of_step({"collision/cloth_terms"}) : 0.0;
        run.total_ms = ms * seconds_;
        run.cull_ms = of_step({"collision/near_pairs", "collision/detect"}) - pressing_ms;
        run.narrow_ms = of_step({"contact/make", "contact/make_on_device", "collision/collision_free_step",
                                 "collision/collision_free_step_to_host"}) +
                        pressing_ms;
        run.minimise_ms = of_step({"pd/descend", "newton/hessian", "newton/coarse", "newton/pcg"});
        run.limit_ms = of_step({"pd/limits"});
        run.iterations /= run.steps;
        run.linear_iterations /= run.steps;
        run.contacts /= run.frames;
        return run;
    }

private:
    SceneRun sum_;
    Stages before_;
    double seconds_ = 0.0;
};

scenes::Scene scene_of(const SceneCase& what)
{
    scenes::Scene scene = scenes::read_scene(what.file);
    if (what.substeps > 0)
        scene.solver.substeps = what.substeps;
    if (what.keeps_solver) {
        if (what.velocity_tolerance > 0.0)
            scene.solver.velocity_tolerance = what.velocity_tolerance;
        return scene;
    }
    scene.solver.method = what.method;
    scene.solver.stop = what.stop.value_or(scene.solver.stop);
    scene.solver.outer = OuterMethod::Lbfgs;
    scene.solver.velocity_tolerance = what.move / scene.step_duration();
    scene.solver.max_iterations = 30;
    return scene;
}

std::vector<Vec3> positions_of(const scenes::World& world)
{
    std::vector<Vec3> positions;
    for (const scenes::ClothState& surface : world.simulated())
        positions.insert(positions.end(), surface.positions.begin(), surface.positions.end());
    return positions;
}

/// @param rows  ascending frame numbers; a row is added at the end of each
void run_on(scenes::Backend backend, const SceneCase& what, const scenes::Scene& scene,
            const std::vector<int>& rows, const CudaSpace& space, std::vector<SceneRun>& runs)
{
    SceneRun start;
    start.name = what.name;
    start.backend = backend == scenes::Backend::Cuda ? "cuda" : "cpu";
    start.dt = scene.step_duration();
    const double free_before = double(space.free_memory());

    scenes::WorldOptions options;
    options.backend = backend;
    static const LiteratureMethods literature;
    options.baselines = &literature;
    std::unique_ptr<scenes::World> world;
    start.load_s = seconds_of([&] { world = std::make_unique<scenes::World>(scene, options); });
    start.prepare_s = seconds_of([&] { world->prepare(); });
    start.settle_s = seconds_of([&] { world->settle(); });
    start.vertices = world->vertex_count();
    start.bodies = int(world->surfaces().size());
    start.crossings_before = crossing_count(*world);

    Tally tally(std::move(start), world->stages());
    std::vector<Vec3> sample;
    for (const int end : rows) {
        while (world->frame() < end) {
            StepReport report;
            const double seconds = seconds_of([&] { report = world->advance_frame(); });
            tally.add(report, seconds);
            if (world->frame() == what.sample_frame)
                sample = positions_of(*world);
        }
        SceneRun run = tally.so_far(world->stages());
        run.crossings = crossing_count(*world);
        run.sample = sample;
        run.device_gb = (free_before - double(space.free_memory())) / kGiga;
        runs.push_back(std::move(run));
    }
}

std::string fraction(double dt) { return "1/" + std::to_string(int(std::lround(1.0 / dt))); }

std::vector<SceneRun> run_only(const std::vector<SceneRun>& runs)
{
    std::vector<SceneRun> made;
    std::copy_if(runs.begin(), runs.end(), std::back_inserter(made),
                 [](const SceneRun& run) { return run.skipped.empty(); });
    return made;
}

Row step_row(const SceneRun& r)
{
    return {r.name,
            r.backend,
            std::to_string(r.vertices),
            fraction(r.dt),
            std::to_string(r.frames),
            format("%.0f", r.iterations),
            format("%.0f", r.linear_iterations),
            format("%.0f", r.contacts),
            format("%.1f", r.cull_ms),
            format("%.1f", r.narrow_ms),
            format("%.1f", r.minimise_ms),
            format("%.1f", r.limit_ms),
            format("%.1f", r.total_ms),
            format("%.1f", r.slowest_ms)};
}

Row run_row(const SceneRun& r)
{
    return {format("%.1f", r.load_s),
            format("%.1f", r.prepare_s),
            format("%.1f", r.settle_s),
            format("%.2f", r.device_gb),
            std::to_string(r.crossings_before),
            std::to_string(r.crossings),
            format("%.1f", 100.0 * r.max_strain),
            std::to_string(r.frames_at_limit)};
}

} // namespace

std::vector<SceneRun> measure_scene(const CudaSpace& space, const SceneCase& what)
{
    scenes::Scene scene;
    try {
        scene = scene_of(what);
    } catch (const InvalidInput& error) {
        if (!what.needs_data)
            throw;
        SceneRun run;
        run.name = what.name;
        run.skipped = error.what();
        return {run};
    }
    std::vector<SceneRun> runs;
    std::vector<int> rows{what.frames};
    if (what.cpu_frames > 0) {
        run_on(scenes::Backend::Cpu, what, scene, {what.cpu_frames}, space, runs);
        if (what.cpu_frames < what.frames)
            rows.insert(rows.begin(), what.cpu_frames);
    }
    run_on(scenes::Backend::Cuda, what, scene, rows, space, runs);
    return runs;
}

std::string markdown_of(const std::vector<SceneRun>& runs)
{
    std::vector<Row> steps, ends;
    for (const SceneRun& run : run_only(runs)) {
        steps.push_back(step_row(run));
        Row end{run.name, run.backend, fraction(run.dt), std::to_string(run.frames)};
        const Row more = run_row(run);
        end.insert(end.end(), more.begin(), more.end());
        ends.push_back(std::move(end));
    }
    std::string text =
        markdown({"scene", "backend", "vertices", "dt", "frames", "iterations", "PCG", "contacts", "cull ms",
                  "narrow ms", "local/global ms", "limits ms", "step ms", "slowest ms"},
                 steps) +
        "\n" +
        markdown({"scene", "backend", "dt", "frames", "load s", "prepare s", "settle s", "GPU GB",
                  "crossings before", "after", "strain %", "frames at limit"},
                 ends);
    for (const SceneRun& run : runs)
        if (!run.skipped.empty())
            text += "\nSKIPPED: scene " + run.name + ": " + run.skipped + "\n";
    return text;
}

std::string csv_of(const std::vector<SceneRun>& runs)
{
    std::vector<Row> rows;
    for (const SceneRun& run : run_only(runs)) {
        rows.push_back(step_row(run));
        const Row more = run_row(run);
        rows.back().insert(rows.back().end(), more.begin(), more.end());
    }
    return csv({"scene",
                "backend",
                "vertices",
                "dt",
                "frames",
                "iterations",
                "pcg",
                "contacts",
                "cull_ms",
                "narrow_ms",
                "local_global_ms",
                "limits_ms",
                "step_ms",
                "slowest_ms",
                "load_s",
                "prepare_s",
                "settle_s",
                "gpu_gb",
                "crossings_before",
                "crossings",
                "strain_percent",
                "frames_at_limit"},
               rows);
}

} // namespace toile::research::gpu
