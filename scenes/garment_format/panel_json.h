#pragma once

#include <optional>

#include "garment/pattern/pattern.h"
#include "scenes/format/document.h"
#include "scenes/format/scene.h"

namespace toile::garment_format {

/// Pattern of a panel JSON, the format of GarmentCode and of its predecessor, the garment pattern generator.
///
/// Lengths are divided by properties.units_in_meter: vertices, translations, absolute control points and
/// radii of circles, but not control points relative to an edge. The rotation of a panel is R = Rx Ry Rz in
/// files of GarmentCode, known by its objects as curvature and by labels, and R = Rz Ry Rx in older ones. A
/// stitch joins the start of one edge to the end of the other, or start to start if "right_wrong" follows.
/// Keys that tell how the template varies are ignored.
/// @param unit  replaces units_in_meter
/// @throws InvalidInput naming the key path, the value and what would be right. What the panels and seams
/// make
///         together is not checked: garment::require_sewable().
garment::Pattern read_panel_json(const scene_format::Document& document, const scene_format::Json& json,
                                 std::optional<scene::LengthUnit> unit);

} // namespace toile::garment_format
