#pragma once

#include <vector>

#include "collision/contact/contact.h"
#include "collision/repair/repair_progress.h"
#include "collision/repair/start_cloth.h"
#include "collision/repair/start_report.h"

namespace toile::collision {

/// Finds the defects of a start pose. Moves nothing. O(n log n).
StartReport check_start(const std::vector<StartCloth>& cloths, const std::vector<ContactCollider>& bodies);

/// [cloths] Vertices, ascending and not fixed, in front of a body but nearer than 0.75 of their gap: contact
/// would throw them off in the first step.
std::vector<std::vector<int>> find_too_near(const std::vector<StartCloth>& cloths,
                                            const std::vector<ContactCollider>& bodies);

/// Repairs a start pose by geometry alone (docs/theory/start_repair.md). Bodies grow from where all cloth is
/// outside and advect it. Higher layers are moved outside lower ones, and cloth that crosses is untangled.
/// The shape is restored as far as this creates no new defects. Triangles that cross a body's surface between
/// their samples are moved off it. Fixed vertices stay. The same bits for every number of threads.
/// @param cloths  positions are moved; if defects remain, the pose with the fewest crossings is kept
StartReport repair_start(std::vector<StartCloth>& cloths, const std::vector<ContactCollider>& bodies,
                         const RepairProgress& progress = RepairProgress(nullptr));

} // namespace toile::collision
