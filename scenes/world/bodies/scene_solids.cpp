#include "scenes/world/bodies/scene_solids.h"

#include "scenes/surfaces/load_solid.h"

namespace toile::scenes {

SceneSolids::SceneSolids(const Scene& scene)
{
    std::vector<RigidShape> shapes;
    for (const scene::Solid& solid : scene.solids) {
        const ClothState& state = states_.emplace_back(load_solid(solid));
        shapes.push_back(rigid_shape_of({state.positions, state.triangles}, solid.density, source_of(solid)));
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
