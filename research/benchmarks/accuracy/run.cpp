#include "research/benchmarks/accuracy/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "garment/energy/principal_stretch.h"
#include "garment/energy/rest_shape.h"
#include "research/benchmarks/text_table.h"
#include "scenes/world/world.h"

namespace toile::research::accuracy {

namespace {

using Clock = std::chrono::steady_clock;

/// Appends the current state.
void append(const scenes::World& world, const std::vector<garment::RestShape>& rest, Trajectory& trajectory)
{
    std::vector<Vec3> x;
    std::vector<double> strain;
    const View<const scenes::ClothState> cloths = world.cloths();
    for (int i = 0; i < cloths.size(); ++i) {
        const std::vector<Vec3>& of_cloth = cloths[i].positions;
        x.insert(x.end(), of_cloth.begin(), of_cloth.end());
        for (int t = 0; t < int(rest[i].triangles.size()); ++t)
            strain.push_back(garment::largest_stretch(rest[i].deformation_gradient(t, of_cloth)) - 1.0);
    }
    trajectory.positions.push_back(std::move(x));
    trajectory.strain.push_back(std::move(strain));
}

const Row kHeader{"case",  "quantity", "right", "from",     "value",
                  "error", "aim",      "holds", "ms/frame", "unfinished"};

Row cells_of(const Result& r)
{
    return {r.name,
            r.quantity,
            format("%.4g", r.right),
            r.from,
            format("%.4g", r.value),
            format("%.2g", r.error),
            format("%.2g", r.aim),
            r.holds ? "yes" : "no",
            format("%.1f", r.ms_per_frame),
            std::to_string(r.unfinished) + " of " + std::to_string(r.frames)};
}

} // namespace

Run run_scene(const Case& trial, const scenes::Scene& scene, const scenes::WorldOptions& options,
              const std::function<bool()>& after_frame)
{
    scenes::World world(scene, options);
    if (trial.place)
        world.place(0, trial.place(world.cloths()[0].positions));
    std::vector<garment::RestShape> rest;
    for (const scenes::ClothState& cloth : world.cloths())
        rest.push_back(garment::rest_shape_of_surface({cloth.rest.positions, cloth.triangles}, Vec3::UnitY(),
                                                      0.0, cloth.name));
    Run run;
    run.trajectory.frame_duration = scene.frame_duration();
    append(world, rest, run.trajectory);
    world.prepare();
    while (run.is_complete && world.frame() + 1 < world.frame_count()) {
        const Clock::time_point start = Clock::now();
        const StepReport report = world.advance_frame();
        run.seconds += std::chrono::duration<double>(Clock::now() - start).count();
        run.unfinished += report.status != StepReport::Status::Converged ? 1 : 0;
        append(world, rest, run.trajectory);
        run.is_complete = after_frame();
    }
    return run;
}

double right_value(const Case& trial, const Trajectory* converged)
{
    return trial.is_measured ? trial.measure(*converged, converged) : trial.right;
}

double error_of(const Case& trial, double value, double right)
{
    return std::abs(value - right) / (trial.is_relative ? std::abs(right) : 1.0);
}

int frames_of(const Case& trial)
{
    return trial.scene.frames - 1 + (trial.reference ? trial.reference->frames - 1 : 0);
}

Result run(const Case& trial, const scenes::WorldOptions& options, const std::function<bool()>& after_frame)
{
    const Run own = run_scene(trial, trial.scene, options, after_frame);
    std::optional<Run> converged;
    if (trial.reference && own.is_complete)
        converged = run_scene(trial, *trial.reference, {}, after_frame);

    Result result;
    result.name = trial.name;
    result.quantity = trial.quantity;
    result.from = trial.reference ? "converged" : "exact";
    result.aim = trial.aim;
    result.frames = int(own.trajectory.positions.size()) - 1;
    result.unfinished = own.unfinished;
    result.ms_per_frame = 1e3 * own.seconds / std::max(1, result.frames);
    if (!own.is_complete || (converged && !converged->is_complete))
        return result;
    const Trajectory* const reference = converged ? &converged->trajectory : nullptr;
    result.right = right_value(trial, reference);
    result.value = trial.measure(own.trajectory, reference);
    result.error = error_of(trial, result.value, result.right);
    result.holds = result.error <= result.aim;
    return result;
}

std::string markdown_table(const std::vector<Result>& results)
{
    return markdown(kHeader, rows_of(results, cells_of));
}

std::string csv_table(const std::vector<Result>& results) { return csv(kHeader, rows_of(results, cells_of)); }

} // namespace toile::research::accuracy
