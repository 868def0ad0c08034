#include <iostream>

#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/interrupt.h"
#include "apps/toile/terminal/progress.h"
#include "core/base/error.h"
#include "research/bench/benchmark.h"
#include "research/bench/tables.h"
#include "research/benchmarks/paper/figures.h"

namespace toile::research {

namespace {

const std::vector<std::string> kTables{"paper_figures.csv", "paper_figures.md"};

constexpr paper::Effort kFull{2500, 0.03};
constexpr paper::Effort kQuick{400, 0.005};

struct Figures {
    const char* name;
    std::vector<paper::Curve> (*measure)(const paper::Effort& effort);
};
constexpr Figures kFigures[] = {{"rule: figures 7, 8 and 9", &paper::rule_curves},
                                {"contact: figure 11", &paper::contact_curves},
                                {"step: figure 12", &paper::step_curves}};

} // namespace

int bench_figures(const BenchOptions& options)
{
    std::vector<Figures> chosen;
    for (const Figures& figures : kFigures)
        if (std::string(figures.name).find(options.only) != std::string::npos)
            chosen.push_back(figures);
    if (chosen.empty())
        throw InvalidInput("--only: no figure has \"" + options.only +
                           "\" in its name; the names are \"rule: figures 7, 8 and 9\", \"contact: figure "
                           "11\" and \"step: figure 12\"");
    if (!options.output.empty())
        require_writable(options.output, kTables);

    const app::InterruptGuard interrupt;
    app::Progress progress("part", int(chosen.size()), options.quiet);
    std::vector<paper::Curve> curves;
    for (size_t i = 0; i < chosen.size() && !interrupt.requested(); ++i) {
        progress.update(int(i), chosen[i].name);
        for (paper::Curve& curve : chosen[i].measure(options.quick ? kQuick : kFull))
            curves.push_back(std::move(curve));
    }
    progress.update(int(chosen.size()));
    std::cout << paper::markdown_of(curves);
    if (interrupt.requested()) {
        std::cerr << "toile: error: interrupted; nothing was written" << std::endl;
        return app::kExitFailure;
    }
    write_tables(options.output,
                 {{kTables[0], paper::csv_of(curves)}, {kTables[1], paper::markdown_of(curves)}});
    return app::kExitOk;
}

} // namespace toile::research
