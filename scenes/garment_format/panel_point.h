#pragma once

#include <optional>

#include "garment/pattern/pattern.h"
#include "scenes/format/document.h"
#include "scenes/garment_format/garment_file.h"

namespace toile::garment_format {

/// Point of a panel named by PANEL.EDGE[0.25] or PANEL[0.1,0.2].
/// @param key_path  where the name stands, for messages
/// @throws InvalidInput as edge_point_of(), and for a point in the plane that is not on the panel
garment::PanelPoint panel_point_of(const scene_format::Document& document, const std::string& key_path,
                                   const std::string& name, const garment::Pattern& pattern);

/// The same point of the k-th copy of its panel; none if the panel is not an original with as many copies.
std::optional<garment::PanelPoint> on_copy(const garment::PanelPoint& point, int k, const GarmentFile& file,
                                           const garment::Pattern& pattern);

} // namespace toile::garment_format
