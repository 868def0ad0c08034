#include <iostream>
#include <optional>

#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/interrupt.h"
#include "apps/toile/terminal/progress.h"
#include "core/base/error.h"
#include "research/bench/benchmark.h"
#include "research/bench/tables.h"
#include "research/benchmarks/stages/table.h"
#include "scenes/format/read_scene.h"

namespace toile::research {

namespace {

const std::vector<std::string> kTables{"scenes.csv", "stages.csv", "stages.md"};

/// Default scenes, relative to the root of the repository.
const std::filesystem::path kDefaultScenes[] = {"scenes/demo/skirt.json", "scenes/data/skirt_walk.json"};

/// Number of frames with --quick.
constexpr int kQuickFrames = 10;

/// Default scenes whose files exist; the others are named on stderr.
std::vector<scenes::Scene> default_scenes()
{
    std::vector<scenes::Scene> scenes;
    for (const std::filesystem::path& file : kDefaultScenes) {
        try {
            scenes.push_back(scenes::read_scene(file));
        } catch (const InvalidInput& error) {
            std::cerr << "SKIPPED: " << error.what() << std::endl;
        }
    }
    return scenes;
}

std::vector<scenes::Scene> chosen_scenes(const BenchOptions& options)
{
    std::vector<scenes::Scene> scenes;
    for (const std::filesystem::path& file : options.scenes)
        scenes.push_back(scenes::read_scene(file));
    if (options.scenes.empty())
        scenes = default_scenes();
    for (scenes::Scene& scene : scenes) {
        scene.frames = options.frames.value_or(options.quick ? kQuickFrames : scene.frames);
        if (scene.frames < 2)
            throw InvalidInput(scene.source.string() + ": has a single frame; give more with --frames");
    }
    return scenes;
}

/// Fastest run of a scene; none if interrupted.
std::optional<stages::Result> best_run(const scenes::Scene& scene, const BenchOptions& options,
                                       const app::InterruptGuard& interrupt)
{
    const int runs = options.quick ? 1 : options.repeats;
    const int frames = scene.frames - 1;
    app::Progress progress("frame", runs * frames, options.quiet);
    std::optional<stages::Result> best;
    for (int k = 0; k < runs; ++k) {
        stages::Result result = stages::run(scene, [&](int frame) {
            progress.update(k * frames + frame, scene.name);
            return !interrupt.requested();
        });
        if (interrupt.requested())
            return std::nullopt;
        if (!best || result.ms_per_frame < best->ms_per_frame)
            best = std::move(result);
    }
    return best;
}

} // namespace

int bench_stages(const BenchOptions& options)
{
    if (!options.output.empty())
        require_writable(options.output, kTables);
    const std::vector<scenes::Scene> scenes = chosen_scenes(options);
    const app::InterruptGuard interrupt;
    std::vector<stages::Result> results;
    for (const scenes::Scene& scene : scenes) {
        const std::optional<stages::Result> result = best_run(scene, options, interrupt);
        if (!result)
            break;
        results.push_back(*result);
    }

    std::cout << markdown_tables(results);
    if (results.size() < scenes.size()) {
        std::cerr << "toile: error: interrupted; nothing was written" << std::endl;
        return app::kExitFailure;
    }
    write_tables(options.output, {{kTables[0], csv_of_scenes(results)},
                                  {kTables[1], csv_of_stages(results)},
                                  {kTables[2], markdown_tables(results)}});
    return app::kExitOk;
}

} // namespace toile::research
