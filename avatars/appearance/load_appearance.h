#pragma once

#include <filesystem>

#include "avatars/model/appearance.h"

namespace toile::avatars {

/// Reads how the file of a body colours it, without decoding images. Of the formats of load_avatar(), on the
/// same triangles.
/// @param triangles  of the loaded body
/// @throws InvalidInput in one line: as load_avatar(), and for materials that can't be read
Appearance load_appearance(const std::filesystem::path& file, const std::vector<Triangle>& triangles);

} // namespace toile::avatars
