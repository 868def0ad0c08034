#pragma once

#include <filesystem>
#include <string>

#include "garment/pattern/pattern.h"

namespace toile::garment_format {

/// Reads and checks a sewing pattern: a garment file ("toile_garment": 1), or a panel JSON by itself.
/// The pattern can be cut and sewn (garment::require_sewable()); seams with swapped ends are left to
/// garment::measure_seam() and garment::sewn_sides().
/// @throws InvalidInput in one line that names the file, the key path or panel and edge, the value and a
/// remedy
garment::Pattern read_pattern(const std::filesystem::path& file);

/// Parses and checks a garment file or panel JSON given as text.
/// @param source  stands for the file in messages; relative paths refer to its folder
garment::Pattern parse_pattern(const std::string& text, const std::filesystem::path& source);

} // namespace toile::garment_format
