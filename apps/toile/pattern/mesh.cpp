#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "apps/toile/pattern/commands.h"
#include "apps/toile/pattern/mesh_report.h"
#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/run_log.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/extension.h"
#include "garment/pattern/mesh/placed_panels.h"
#include "scenes/garment_format/read_garment.h"

namespace toile::app {

namespace {

struct MeshOptions {
    std::filesystem::path file;
    std::filesystem::path output; ///< empty: no mesh is written
    double edge = 0.01;           ///< [m]
    bool json = false;
};

void require_valid(const MeshOptions& options)
{
    require_edge_option(options.edge);
    if (!options.output.empty() && lower_case_extension(options.output) != ".obj" &&
        !is_stream(options.output))
        throw InvalidInput(options.output.string() + ": meshes are OBJ; name a file that ends in .obj");
}

int mesh(const MeshOptions& options)
{
    require_valid(options);
    garment::Pattern pattern = garment_format::read_pattern(options.file);
    if (!options.output.empty())
        require_safe_output(options.output, "the mesh", pattern);
    const MeshReport report = mesh_report_on(std::move(pattern), options.edge);
    if (!options.output.empty())
        write_obj(options.output, placed_panels(report.pattern.pattern, report.mesh));
    std::cout << (options.json ? to_json(report) : to_text(report));
    const std::string failure = failure_of(report);
    if (failure.empty())
        return kExitOk;
    RunLog(false).error(failure);
    return kExitFailure;
}

} // namespace

Command add_pattern_mesh(CLI::App& parser)
{
    Command command;
    command.options =
        parser.add_subcommand("mesh", "Fill the panels of a pattern with triangles that match along seams");
    auto options = std::make_shared<MeshOptions>();
    CLI::App& add = *command.options;
    add.add_option("file", options->file, "Garment file or panel JSON")->required();
    add.add_option("-o,--output", options->output,
                   "Write the panels, where they start in space, to this .obj; its lines are the stitches");
    add.add_option("--edge", options->edge,
                   "Length of edges [m] in panels that have none of their own; 0.01");
    add.add_flag("--json", options->json, "Print JSON instead of lines");
    command.run = [options] { return mesh(*options); };
    return command;
}

} // namespace toile::app
