#pragma once

#include "garment/pattern/pattern.h"
#include "scenes/format/document.h"

namespace toile::garment_format {

/// Part of an edge, or of a line inside of a panel, named by PANEL.EDGE or PANEL.EDGE[from:to].
/// @param key_path  where the name stands, for messages
/// @throws InvalidInput, with the nearest name, for a panel or edge that does not exist, a label of several
///         edges, and fractions outside 0 to 1 or of no length
garment::EdgePart edge_part_of(const scene_format::Document& document, const std::string& key_path,
                               const std::string& name, const garment::Pattern& pattern);

/// Point of an edge.
struct EdgePoint {
    int panel = 0;         ///< index into Pattern::panels
    int edge = 0;          ///< index into Panel::edges
    double fraction = 0.0; ///< [-] of the edge's length
};

/// Point of an edge named by PANEL.EDGE[0.25].
/// @throws InvalidInput as edge_part_of()
EdgePoint edge_point_of(const scene_format::Document& document, const std::string& key_path,
                        const std::string& name, const garment::Pattern& pattern);

} // namespace toile::garment_format
