#include <cmath>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/toile/terminal/command_line.h"
#include "core/base/error.h"
#include "core/base/extension.h"
#include "core/base/file_plan.h"
#include "core/base/number.h"
#include "core/mesh/clean.h"
#include "core/mesh/obj.h"
#include "core/mesh/solid_moments.h"
#include "scenes/format/field.h"
#include "scenes/format/scene.h"
#include "volume/mesh/msh.h"
#include "volume/mesh/quality.h"
#include "volume/meshing/fill_surface.h"

namespace toile::app {

namespace {

struct MeshOptions {
    std::filesystem::path surface;
    std::filesystem::path output;
    double cell = 0.0;      ///< [m]
    std::string unit = "m"; ///< of the surface
    bool json = false;
};

void require_valid(const MeshOptions& options)
{
    if (lower_case_extension(options.surface) != ".obj")
        throw InvalidInput(options.surface.string() + ": is no .obj; give a closed surface");
    if (lower_case_extension(options.output) != ".msh")
        throw InvalidInput(options.output.string() + ": tetrahedra are written as .msh; name such a file");
    if (!(options.cell > 0.0) || !std::isfinite(options.cell))
        throw InvalidInput("--cell: " + short_text(options.cell) +
                           " m; it must be the length of an edge, such as 0.02");
    FilePlan plan;
    plan.add_input(options.surface, "the surface");
    plan.add_output(options.output, "the tetrahedra");
}

int mesh(const MeshOptions& options)
{
    require_valid(options);
    TriangleMesh surface = stitched_surface(read_obj(options.surface));
    const double scale = scene::metres_per(scene_format::value_of<scene::LengthUnit>(options.unit));
    for (Vec3& p : surface.positions)
        p *= scale;
    const std::string source = options.surface.string();
    require_usable(surface, source);
    const volume::TetMesh tets = volume::fill_surface(surface, options.cell, source);
    volume::write_msh(options.output, tets);

    const volume::MeshQuality quality = volume::quality_of(tets);
    const double volume_error = quality.volume / solid_moments(surface, source).volume - 1.0;
    if (options.json) {
        std::cout << nlohmann::ordered_json{{"file", options.output.string()},
                                            {"vertices", tets.vertex_count()},
                                            {"tetrahedra", tets.tet_count()},
                                            {"inverted", quality.inverted},
                                            {"smallest_dihedral_deg", quality.smallest_dihedral},
                                            {"mean_edge", quality.mean_edge},
                                            {"volume", quality.volume},
                                            {"volume_error", volume_error}}
                         .dump(2)
                  << '\n';
        return kExitOk;
    }
    std::cout << options.output.string() << ": " << tets.vertex_count() << " vertices, " << tets.tet_count()
              << " tetrahedra, edges of " << short_text(quality.mean_edge) << " m, smallest dihedral angle "
              << short_text(quality.smallest_dihedral) << " degrees, volume "
              << short_text(100.0 * volume_error) << " % from that of the surface\n";
    return kExitOk;
}

} // namespace

Command add_mesh(CLI::App& parser)
{
    Command command;
    command.options = parser.add_subcommand("mesh", "Fill a closed surface with tetrahedra, for soft bodies");
    auto options = std::make_shared<MeshOptions>();
    CLI::App& add = *command.options;
    add.add_option("surface", options->surface, "Closed surface (.obj)")->required();
    add.add_option("-o,--output", options->output, "Tetrahedra to write (.msh of Gmsh)")->required();
    add.add_option("--cell", options->cell, "Length of edges [m]")->required();
    add.add_option("--unit", options->unit, "Unit of the surface; tetrahedra are written in metres [m]")
        ->check(CLI::IsMember(scene_format::words_of<scene::LengthUnit>()));
    add.add_flag("--json", options->json, "Print JSON instead of a line");
    command.run = [options] { return mesh(*options); };
    return command;
}

} // namespace toile::app
