#include "scenes/world/bodies/scene_bodies.h"

namespace toile::scenes {

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
