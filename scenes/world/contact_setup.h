#pragma once

#include <vector>

#include "collision/contact/contact.h"
#include "scenes/world/bodies/scene_soft_bodies.h"
#include "scenes/world/bodies/scene_solids.h"
#include "scenes/world/scene_cloth.h"

namespace toile::scenes {

/// Settings of Contact for a scene.
collision::Contact::Settings contact_settings(const Scene& scene);

/// Gaps, thicknesses and friction of the cloths, then of the soft bodies, then of the solids.
/// @param soft_bodies, solids  null: none
std::vector<collision::ContactCloth> contact_cloths(const Scene& scene, const std::vector<SceneCloth>& cloths,
                                                    const SceneSoftBodies* soft_bodies,
                                                    const SceneSolids* solids,
                                                    const std::vector<const Collider*>& colliders);

/// Thickness of contact around soft bodies and solids [m].
double skin_of_body(const Scene& scene);

/// Largest room that a cloth of the scene needs between two surfaces that face each other [m].
double room_for_cloth(const Scene& scene);

/// Avatars in contact: all but those that a soft body replaces.
std::vector<const Collider*> colliders_in_contact(const Scene& scene, const std::vector<Collider>& colliders);

std::vector<collision::ContactCollider> contact_colliders(const std::vector<const Collider*>& colliders);

} // namespace toile::scenes
