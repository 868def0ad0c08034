#pragma once

#include <functional>
#include <string>
#include <vector>

#include "collision/repair/start_report.h"
#include "scenes/world/cloth_group.h"

namespace toile::scenes {

/// Part of a scene.
struct NamedPart {
    std::string kind; ///< "cloth", "soft body" or "avatar"
    std::string name;

    std::string quoted() const; ///< cloth "skirt"
};

/// What the numbers in a StartReport of a World stand for: surfaces are the scene's cloths, then its soft
/// bodies; bodies are its avatars, then its soft bodies.
NamedPart surface_of(const Scene& scene, int number);
NamedPart body_of(const Scene& scene, int number);

/// Checks the start pose and repairs it if cloth or a soft body is inside a body, crosses one or another
/// surface, or lies under a lower layer: stages "scenes/start_check" and, only if needed,
/// "scenes/start_repair". Soft bodies are moved first; cloth then takes them for bodies. Rest shapes do not
/// change. If no crossing remains, the groups skip their search.
/// @param progress  receives the finished fraction [0, 1]; may be empty
/// @throws InvalidInput for cloth or a soft body that does not fit its pose: it would have to move by more
///         than 5 cm, or 1 % of its edges would be strained by more than 20 %
collision::StartReport repair_start_pose(const Scene& scene, std::vector<ClothGroup>& groups,
                                         const std::vector<Collider>& colliders,
                                         const std::function<void(double)>& progress);

} // namespace toile::scenes
