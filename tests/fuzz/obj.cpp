#include "core/base/error.h"
#include "core/mesh/clean.h"
#include "core/mesh/topology.h"
#include "core/mesh/winding.h"
#include "tests/fuzz/input_file.h"

/// OBJ meshes, with all that is done to those of cloth before it is simulated.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const toile::test::InputFile file(".obj");
    try {
        toile::ObjMesh mesh = toile::read_obj(file.write(data, size));
        toile::drop_repeated_corners(mesh);
        toile::drop_repeated_polygons(mesh);
        toile::surface_topology(mesh.triangulated().triangles);
        toile::stitch(mesh, 1e-9);
        toile::make_windings_agree(mesh);
        toile::require_usable(mesh, "mesh.obj");
        toile::drop_loose_vertices(mesh);
        toile::drop_repeated_lines(mesh);
        toile::branching_edges(mesh);
        toile::one_sided_polygons(mesh);
        toile::build_branching_topology(mesh.triangulated(), "mesh.obj");
    } catch (const toile::InvalidInput&) {
    }
    return 0;
}
