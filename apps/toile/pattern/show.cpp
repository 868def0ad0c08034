#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "apps/toile/pattern/commands.h"
#include "apps/toile/pattern/drawing.h"
#include "apps/toile/pattern/report.h"
#include "apps/toile/terminal/command_line.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/extension.h"
#include "scenes/garment_format/read_garment.h"

namespace toile::app {

namespace {

struct ShowOptions {
    std::filesystem::path file;
    std::filesystem::path output; ///< empty: no drawing
    bool json = false;
};

int show(const ShowOptions& options)
{
    if (!options.output.empty() && lower_case_extension(options.output) != ".svg" &&
        !is_stream(options.output))
        throw InvalidInput(options.output.string() + ": drawings are SVG; name a file that ends in .svg");
    const PatternReport report = report_on(garment_format::read_pattern(options.file));
    if (!options.output.empty()) {
        require_safe_output(options.output, "the drawing", report.pattern);
        write_atomically(options.output, to_svg(report));
    }
    std::cout << (options.json ? to_json(report) : to_text(report));
    return kExitOk;
}

} // namespace

Command add_pattern_show(CLI::App& parser)
{
    Command command;
    command.options =
        parser.add_subcommand("show", "Draw the panels of a pattern, and print their edges and seams");
    auto options = std::make_shared<ShowOptions>();
    CLI::App& add = *command.options;
    add.add_option("file", options->file, "Garment file or panel JSON")->required();
    add.add_option("-o,--output", options->output, "Write a drawing to this .svg");
    add.add_flag("--json", options->json, "Print JSON instead of lines");
    command.run = [options] { return show(*options); };
    return command;
}

} // namespace toile::app
