#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "collision/repair/start_report.h"
#include "scenes/format/scene.h"

namespace toile::app {

/// Defects of a start pose and those that its repair left, for the user: a sentence, and a line for each of
/// the first remaining defects. Empty if there were none.
std::string start_text(const collision::StartReport& report, const scenes::Scene& scene);

/// Defects of a start pose for the run report, all of them: position, kind, depth, cloth, avatar or other
/// cloth, and whether it was repaired.
nlohmann::ordered_json start_json(const collision::StartReport& report, const scenes::Scene& scene);

} // namespace toile::app
