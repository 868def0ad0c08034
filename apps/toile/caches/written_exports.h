#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "scenes/format/scene.h"

namespace toile::app {

/// Exports as a scene lists them, every key written out.
nlohmann::ordered_json json_of(const std::vector<scene::Export>& exports);

/// The exports that a certificate says its run has written: those of the scene, or of `simulate --export`.
/// @param certificate  may be missing
/// @return none if it is missing or says nothing
/// @throws InvalidInput for a file that is no certificate
std::optional<std::vector<scene::Export>> exports_in(const std::filesystem::path& certificate);

} // namespace toile::app
