#include <iostream>

#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/interrupt.h"
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

/// Frames to measure after the start pose.
int frames_of(const std::filesystem::path& scene, const BenchOptions& options)
{
    if (options.frames)
        return *options.frames - 1;
    return options.quick ? kQuickFrames : scenes::read_scene(scene).frames - 1;
}

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
    std::cout << space.described() << "\n\n" << paper::markdown_header() << std::flush;
    std::vector<TableFile> tables;
    paper::TableCalls calls;
    calls.measure = [&](const std::filesystem::path& scene, paper::TableMethod method) {
        return paper::measure_row(space, scene, method, frames_of(scene, options));
    };
    calls.finished = [&](const std::vector<paper::TableRow>& rows) {
        std::cout << paper::markdown_of(rows.back()) << std::flush;
        tables = {{kTables[0], paper::csv_of(rows)}, {kTables[1], paper::markdown_of(rows)}};
        update_tables(options.output, tables);
    };
    calls.failed = [](const std::string& error) { std::cerr << "toile: error: " << error << std::endl; };
    calls.has_sample =
        !options.quick && options.frames.value_or(paper::kSampleFrame + 1) > paper::kSampleFrame;
    calls.goes_on = [&] { return !interrupt.requested(); };
    const bool has_all = paper::measure_table1(options.scenes, calls);
    write_tables(options.output, tables);
    if (interrupt.requested())
        std::cerr << "toile: error: interrupted; the tables have the rows before" << std::endl;
    return has_all && !interrupt.requested() ? app::kExitOk : app::kExitFailure;
}

} // namespace toile::research
