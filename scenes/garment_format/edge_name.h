#pragma once

#include "garment/pattern/pattern.h"
#include "scenes/format/document.h"

namespace toile::garment_format {

/// Part of an edge named by PANEL.EDGE or PANEL.EDGE[from:to].
/// @param key_path  where the name stands, for messages
/// @throws InvalidInput, with the nearest name, for a panel or edge that does not exist, a label of several
///         edges, and fractions outside 0 to 1 or of no length
garment::EdgePart edge_part_of(const scene_format::Document& document, const std::string& key_path,
                               const std::string& name, const garment::Pattern& pattern);

} // namespace toile::garment_format
