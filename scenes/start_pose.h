#pragma once

#include <vector>

#include "collision/untangle/start_report.h"
#include "scenes/cloth_group.h"

namespace toile {

/// Looks at the pose that cloths start in and repairs it where cloth is inside a body or crosses cloth:
/// stages "scenes/start_check" and, for poses that need it only, "scenes/start_repair". Rest shapes stay as
/// they are. Groups are told where nothing crosses, then. Places are numbered by scene: cloth and avatar as
/// they stand in `cloths` and `obstacles`.
StartReport repair_start_pose(const Scene& scene, std::vector<ClothGroup>& groups,
                              const std::vector<Obstacle>& obstacles);

} // namespace toile
