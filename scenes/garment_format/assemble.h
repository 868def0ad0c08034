#pragma once

#include "scenes/format/document.h"
#include "scenes/garment_format/garment_file.h"

namespace toile::garment_format {

/// Pattern that a garment file describes: its patterns' panels and stitches, the copies, settings and seams.
/// @param parts  [patterns] contents of the files that it names
/// @throws InvalidInput naming the key path, for panels, edges and fabrics that do not exist, and names that
/// two
///         files give
garment::Pattern assemble(const scene_format::Document& document, const GarmentFile& file,
                          const std::vector<garment::Pattern>& parts);

} // namespace toile::garment_format
