#include "scenes/world/bodies/scene_bodies.h"

namespace toile::scenes {

long SceneBodies::vertex_count() const
{
    long count = solids ? solids->bodies().unknown_count() : 0;
    for (int i = 0; soft_bodies && i < soft_bodies->count(); ++i)
        count += long(soft_bodies->rest_positions(i).size());
    return count;
}

SceneBodies make_bodies(const Scene& scene, const std::vector<Collider>& colliders, int cloth_vertices)
{
    SceneBodies bodies;
    if (!scene.solids.empty())
        bodies.solids = std::make_unique<SceneSolids>(scene);
    if (!scene.soft_bodies.empty())
        bodies.soft_bodies = std::make_unique<SceneSoftBodies>(
            scene, colliders, cloth_vertices, bodies.solids ? bodies.solids->bodies().unknown_count() : 0);
    return bodies;
}

} // namespace toile::scenes
