#include <iostream>

#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/interrupt.h"
#include "apps/toile/terminal/progress.h"
#include "core/base/error.h"
#include "research/bench/benchmark.h"
#include "research/bench/tables.h"
#include "research/benchmarks/scaling/run.h"
#include "scenes/format/read_scene.h"

namespace toile::research {

namespace {

const std::vector<std::string> kTables{"scaling.csv", "scaling.md"};

/// Default scene, relative to the root of the repository, and the frames in which its cloth lands.
const std::filesystem::path kScene = "scenes/demo/tablecloth.json";
constexpr int kFrames = 31;

const std::vector<int> kVertices{1000, 2000, 5000, 10000, 20000, 40000, 80000},
    kQuickVertices{500, 1000, 2000};

} // namespace

int bench_scaling(const BenchOptions& options)
{
    if (!options.output.empty())
        require_writable(options.output, kTables);
    if (options.scenes.size() > 1)
        throw InvalidInput("scaling: takes one scene, not " + std::to_string(options.scenes.size()));
    scenes::Scene scene = scenes::read_scene(options.scenes.empty() ? kScene : options.scenes.front());
    scene.frames = options.frames.value_or(kFrames);
    const std::vector<int>& sizes = options.quick ? kQuickVertices : kVertices;
    double total = 0.0;
    for (const int vertices : sizes)
        total += vertices;

    const app::InterruptGuard interrupt;
    app::Progress progress("thousand vertex frames", int(1e-3 * total * (scene.frames - 1)), options.quiet);
    std::vector<scaling::Result> results;
    double done = 0.0;
    for (const int vertices : sizes) {
        const scaling::Result result = scaling::run(scaling::with_vertices(scene, vertices), [&](int frame) {
            progress.update(int(1e-3 * (done + double(frame) * vertices)),
                            std::to_string(vertices) + " vertices");
            return !interrupt.requested();
        });
        if (interrupt.requested())
            break;
        done += double(vertices) * (scene.frames - 1);
        results.push_back(result);
    }

    std::cout << scaling::markdown_table(results);
    if (interrupt.requested()) {
        std::cerr << "toile: error: interrupted; nothing was written" << std::endl;
        return app::kExitFailure;
    }
    write_tables(options.output,
                 {{kTables[0], scaling::csv_table(results)}, {kTables[1], scaling::markdown_table(results)}});
    return app::kExitOk;
}

} // namespace toile::research
