#pragma once

#include "scenes/format/document.h"
#include "scenes/garment_format/garment_file.h"

namespace toile::garment_format {

/// Adds the folds of a garment file to its pattern, those of panels that are cut more than once on all of
/// their copies.
/// @param pattern  with its copies
/// @throws InvalidInput naming the key path, for panels and edges that do not exist, a fold that has not one
///         line, and points of two panels. Whether lines lie in their panels is left to the mesher.
void add_folds(const scene_format::Document& document, const GarmentFile& file, garment::Pattern& pattern);

} // namespace toile::garment_format
