#pragma once

#include <vector>

#include "collision/contact.h"
#include "collision/untangle/start_cloth.h"
#include "collision/untangle/start_report.h"

namespace toile {

/// What is wrong with a start pose: points of cloth inside bodies, and triangles of cloth that cross. Moves
/// nothing; O(n log n).
StartReport check_start(const std::vector<StartCloth>& cloths, const std::vector<ContactPartner>& bodies);

/// Repairs a start pose by geometry alone (docs/collision/start_repair.md): bodies grow back from where all
/// cloth is outside and carry it along; higher layers are brought outside lower ones; cloth that crosses is
/// untangled; shape is restored as far as none of this is undone. Held vertices stay. The same bits for every
/// number of threads.
/// @param cloths  positions are moved. Of what can't be repaired the pose with the fewest crossings is kept.
StartReport repair_start(std::vector<StartCloth>& cloths, const std::vector<ContactPartner>& bodies);

} // namespace toile
