#pragma once

#include <functional>
#include <vector>

#include "collision/repair/start_report.h"
#include "scenes/world/cloth_group.h"

namespace toile::scenes {

/// Checks the start pose and repairs it if cloth is inside a body, crosses one or other cloth, or lies under
/// a lower layer: stages "scenes/start_check" and, only if needed, "scenes/start_repair". Rest shapes do not
/// change. If no crossing remains, the groups skip their search. Defects are numbered by scene: cloth and
/// avatar as in `cloths` and `colliders`.
/// @param progress  receives the finished fraction [0, 1]; may be empty
/// @throws InvalidInput for cloth that does not fit its pose: it would have to move by more than 5 cm, or 1 %
///         of its edges would be strained by more than 20 %
collision::StartReport repair_start_pose(const Scene& scene, std::vector<ClothGroup>& groups,
                                         const std::vector<Collider>& colliders,
                                         const std::function<void(double)>& progress);

} // namespace toile::scenes
