#include <iostream>

#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/interrupt.h"
#include "apps/toile/terminal/progress.h"
#include "core/base/error.h"
#include "research/bench/benchmark.h"
#include "research/bench/tables.h"
#include "research/benchmarks/paper/table1.h"
#include "scenes/format/read_scene.h"

namespace toile::research {

namespace {

const std::vector<std::string> kTables{"paper_table1.csv", "paper_table1.md"};

/// Number of frames with --quick.
constexpr int kQuickFrames = 4;

} // namespace

int bench_paper(const BenchOptions& options)
{
    if (options.scenes.empty())
        throw InvalidInput("paper: name scenes of the paper, such as out/letters/letters.json; "
                           "assets/paper/make_scene.py makes them");
    if (!options.output.empty())
        require_writable(options.output, kTables);
    if (const std::string why = why_no_cuda_device(); !why.empty())
        throw InvalidInput("paper: needs a GPU: " + why);
    const CudaSpace space(0);
    const app::InterruptGuard interrupt;
    app::Progress progress("scene", int(options.scenes.size()), options.quiet);
    std::vector<paper::TableRow> rows;
    for (size_t i = 0; i < options.scenes.size() && !interrupt.requested(); ++i) {
        const int frames = scenes::read_scene(options.scenes[i]).frames - 1;
        for (paper::TableRow& row : paper::measure_table1(space, options.scenes[i],
                                                          options.frames  ? *options.frames - 1
                                                          : options.quick ? kQuickFrames
                                                                          : frames))
            rows.push_back(std::move(row));
        progress.update(int(i) + 1, options.scenes[i].stem().string());
    }
    std::cout << space.described() << "\n\n" << paper::markdown_of(rows);
    if (interrupt.requested()) {
        std::cerr << "toile: error: interrupted; nothing was written" << std::endl;
        return app::kExitFailure;
    }
    write_tables(options.output, {{kTables[0], paper::csv_of(rows)}, {kTables[1], paper::markdown_of(rows)}});
    return app::kExitOk;
}

} // namespace toile::research
