#pragma once

#include <vector>

#include "collision/repair/start_report.h"
#include "scenes/world/cloth_group.h"

namespace toile::scenes {

/// Checks the start pose and repairs it if cloth is inside a body or crosses cloth: stages
/// "scenes/start_check" and, only if needed, "scenes/start_repair". Rest shapes do not change. If no crossing
/// remains, the groups skip their search. Defects are numbered by scene: cloth and avatar as in `cloths` and
/// `colliders`.
collision::StartReport repair_start_pose(const Scene& scene, std::vector<ClothGroup>& groups,
                                         const std::vector<Collider>& colliders);

} // namespace toile::scenes
