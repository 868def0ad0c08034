#include "scenes/world/scene_solids.h"

#include "core/base/extension.h"
#include "core/mesh/vtk.h"
#include "core/mesh/weld.h"
#include "scenes/meshes/rigid_motion.h"
#include "scenes/meshes/shape_mesh.h"

namespace toile::scenes {

namespace {

/// Name of the solid in errors: its file, or solid "name".
std::string source_of(const scene::Solid& solid)
{
    const auto* file = std::get_if<std::filesystem::path>(&solid.shape);
    return file ? file->string() : "solid \"" + solid.name + "\"";
}

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
    return lower_case_extension(*file) == ".vtk" ? boundary_surface(read_vtk_tets(*file))
                                                 : read_obj(*file).triangulated();
}

} // namespace

TriangleMesh solid_mesh(const scene::Solid& solid)
{
    TriangleMesh mesh = surface_of(solid);
    require_usable(mesh, source_of(solid));
    const double scale = solid.scale * scene::metres_per(solid.unit);
    const Mat3 rotation = rotation_of(solid.rotate_deg);
    for (Vec3& p : mesh.positions)
        p = solid.translate + rotation * (scale * p);
    return mesh;
}

SceneSolids::SceneSolids(const Scene& scene)
{
    std::vector<RigidShape> shapes;
    for (const scene::Solid& solid : scene.solids) {
        const TriangleMesh mesh = solid_mesh(solid);
        shapes.push_back(rigid_shape_of(mesh, solid.density, source_of(solid)));
        ClothState& state = states_.emplace_back();
        state.name = solid.name;
        state.positions = mesh.positions;
        state.triangles = mesh.triangles;
        state.rest = faces_of(mesh);
        state.fabric.strain_limit = 0.0;
    }
    bodies_ = std::make_unique<RigidBodies>(std::move(shapes));
    for (int i = 0; i < count(); ++i)
        bodies_->set_velocity(i, scene.solids[i].velocity, scene.solids[i].spin);
}

std::vector<Vec3> SceneSolids::positions(int solid) const
{
    const View<const Vec3> vertices =
        bodies_->surface().subview(bodies_->first_vertex(solid), int(states_[solid].positions.size()));
    return {vertices.begin(), vertices.end()};
}

void SceneSolids::append_triangles(int first_vertex, std::vector<Triangle>& triangles) const
{
    for (int i = 0; i < count(); ++i)
        for (const Triangle& t : states_[i].triangles)
            triangles.push_back(t + Triangle::Constant(first_vertex + bodies_->first_vertex(i)));
}

} // namespace toile::scenes
