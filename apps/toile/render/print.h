#pragma once

#include "apps/preview/render_scene.h"
#include "scenes/format/scene.h"
#include "scenes/surfaces/cloth_state.h"

namespace toile::app {

/// Linear RGB of an sRGB colour, both in [0, 1].
Vec3 linear_color(const Vec3& srgb);

/// Applies the cloth's print to a mesh of a picture, in metres of the cloth. It lies on the flat rest shape,
/// the file's texture coordinates, the plane of a flat cut, or the surface of a skirt; other cloth stays
/// plain.
/// @param state  the cloth, placed as it starts
void apply_print(const scene::Cloth& cloth, const scenes::ClothState& state, preview::RenderMesh& mesh);

} // namespace toile::app
