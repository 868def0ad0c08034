#include "research/benchmarks/stages/run.h"

#include <algorithm>
#include <chrono>
#include <numeric>

#include "core/base/process_usage.h"
#include "scenes/world/world.h"

namespace toile::research::stages {

namespace {

using Clock = std::chrono::steady_clock;
using Entries = std::map<std::string, Stages::Entry, std::less<>>;

double milliseconds_since(Clock::time_point start)
{
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Stages entered since `before`, longest first.
std::vector<Stage> stages_since(const Entries& before, const Entries& now, int frames, double total_ms)
{
    std::vector<Stage> stages;
    for (const auto& [name, entry] : now) {
        const auto old = before.find(name);
        const Stages::Entry start = old == before.end() ? Stages::Entry{} : old->second;
        const double ms = 1e3 * (entry.seconds - start.seconds);
        if (ms >= kMinStageFraction * total_ms)
            stages.push_back({name, double(entry.calls - start.calls) / frames, ms / frames, ms / total_ms});
    }
    std::sort(stages.begin(), stages.end(), [](const Stage& a, const Stage& b) { return a.ms > b.ms; });
    return stages;
}

void set_times(Result& result, std::vector<double> frame_ms)
{
    const double total = std::accumulate(frame_ms.begin(), frame_ms.end(), 0.0);
    std::sort(frame_ms.begin(), frame_ms.end());
    result.frames = int(frame_ms.size());
    result.ms_per_frame = total / result.frames;
    result.median_ms = frame_ms[frame_ms.size() / 2];
    result.slowest_ms = frame_ms.back();
}

} // namespace

Result run(const scenes::Scene& scene, const std::function<bool(int)>& after_frame)
{
    Result result;
    result.name = scene.name;
    const Clock::time_point load_start = Clock::now();
    scenes::World world(scene);
    world.settle();
    result.load_s = 1e-3 * milliseconds_since(load_start);
    for (const scenes::ClothState& cloth : world.cloths())
        result.vertices += int(cloth.positions.size());

    const Entries before = world.stages().entries();
    const double user_start = user_seconds();
    std::vector<double> frame_ms;
    while (world.frame() + 1 < scene.frames) {
        const Clock::time_point start = Clock::now();
        const StepReport report = world.advance_frame();
        frame_ms.push_back(milliseconds_since(start));
        result.iterations += report.iterations;
        result.contacts += report.contacts;
        if (!after_frame(world.frame()) || report.status == StepReport::Status::NonFinite)
            break;
    }
    result.peak_memory = peak_memory();
    if (frame_ms.empty())
        return result;
    set_times(result, frame_ms);
    result.user_ms = 1e3 * (user_seconds() - user_start) / result.frames;
    result.iterations /= result.frames;
    result.contacts /= result.frames;
    result.stages =
        stages_since(before, world.stages().entries(), result.frames, result.frames * result.ms_per_frame);
    return result;
}

} // namespace toile::research::stages
