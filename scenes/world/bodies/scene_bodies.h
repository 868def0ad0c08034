#pragma once

#include <memory>
#include <vector>

#include "scenes/world/bodies/scene_soft_bodies.h"
#include "scenes/world/bodies/scene_solids.h"

namespace toile::scenes {

/// Bodies that the cloths of a scene move with.
struct SceneBodies {
    std::unique_ptr<SceneSolids> solids;          ///< null: none
    std::unique_ptr<SceneSoftBodies> soft_bodies; ///< null: none

    bool any() const { return solids || soft_bodies; }
};

/// @param cloth_vertices  of all cloths, which come first among the unknowns
/// @throws InvalidInput for a mesh, material or attachment that does not work
SceneBodies make_bodies(const Scene& scene, const std::vector<Collider>& colliders, int cloth_vertices);

} // namespace toile::scenes
