#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "collision/untangle/start_report.h"
#include "scenes/format/scene.h"

namespace toile {

/// What a start pose had wrong and what its repair left, for the user: a sentence, and a line for each of the
/// first places that remain. Empty when nothing was wrong.
std::string start_text(const StartReport& report, const Scene& scene);

/// The same for the run report, with every place: position, kind, depth, cloth, what it met, and whether it
/// was repaired.
nlohmann::ordered_json start_json(const StartReport& report, const Scene& scene);

} // namespace toile
