#include "scenes/surfaces/load_solid.h"

#include "core/base/extension.h"
#include "core/mesh/clean.h"
#include "core/mesh/weld.h"
#include "scenes/meshes/rigid_motion.h"
#include "scenes/meshes/shape_mesh.h"
#include "volume/mesh/vtk.h"

namespace toile::scenes {

namespace {

collision::Shape shape_of(const scene::SolidShape& shape)
{
    if (const auto* sphere = std::get_if<scene::Sphere>(&shape))
        return collision::SphereShape{sphere->radius};
    if (const auto* capsule = std::get_if<scene::Capsule>(&shape))
        return collision::CapsuleShape{0.5 * capsule->length, capsule->radius};
    return collision::BoxShape{0.5 * std::get<scene::Box>(shape).size};
}

/// Surface in its local frame, before placement.
TriangleMesh surface_of(const scene::Solid& solid)
{
    const auto* file = std::get_if<std::filesystem::path>(&solid.shape);
    if (!file)
        return weld(shape_mesh(shape_of(solid.shape), 0.0), 0.0).mesh; // welds the corners of a box
    return lower_case_extension(*file) == ".vtk" ? volume::boundary_surface(volume::read_vtk_tets(*file))
                                                 : stitched_surface(read_obj(*file));
}

} // namespace

std::string source_of(const scene::Solid& solid)
{
    const auto* file = std::get_if<std::filesystem::path>(&solid.shape);
    return file ? file->string() : "solid \"" + solid.name + "\"";
}

ClothState load_solid(const scene::Solid& solid)
{
    TriangleMesh mesh = surface_of(solid);
    require_usable(mesh, source_of(solid));
    const double scale = solid.scale * scene::metres_per(solid.unit);
    const Mat3 rotation = rotation_of(solid.rotate_deg);
    for (Vec3& p : mesh.positions)
        p = solid.translate + rotation * (scale * p);
    ClothState state;
    state.name = solid.name;
    state.rest = faces_of(mesh);
    state.positions = std::move(mesh.positions);
    state.triangles = std::move(mesh.triangles);
    state.fabric.strain_limit = 0.0;
    return state;
}

} // namespace toile::scenes
