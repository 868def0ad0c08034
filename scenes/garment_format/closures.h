#pragma once

#include "scenes/format/document.h"
#include "scenes/garment_format/garment_file.h"

namespace toile::garment_format {

/// Adds the closures of a garment file to its pattern, and repeats them on copies of both panels.
/// @param pattern  with its copies
/// @throws InvalidInput naming the key path, for points that no panel has, and a closure of one point
void add_closures(const scene_format::Document& document, const GarmentFile& file, garment::Pattern& pattern);

} // namespace toile::garment_format
