#pragma once

#include <string>
#include <vector>

#include "scenes/format/scene.h"

namespace toile::scenes {

/// Checks a scene made or changed in code as strictly as one read from a file. Files that it names must exist
/// but are not opened.
/// @throws InvalidInput in one line, as read_scene(): numbers that are out of range or not finite, unknown
///         enumerators, contradictory settings, names that do not exist
void require_valid(const Scene& scene);

/// Warnings about keys of a scene file that have another name now, one line each. The former key of the
/// solver is solver_warnings_of()'s.
std::vector<std::string> former_key_warnings_of(const Scene& scene);

} // namespace toile::scenes
