#pragma once

#include "apps/preview/render_scene.h"
#include "core/mesh/obj.h"
#include "scenes/format/scene.h"

namespace toile::app {

/// Linear RGB of an sRGB colour, both in [0, 1].
Vec3 linear_color(const Vec3& srgb);

/// Applies the cloth's pattern to a mesh of a picture, in metres of the cloth. It uses the file's texture
/// coordinates, the plane of a flat cut, or the surface of a skirt; other cloth stays plain.
/// @param rest       the unstretched cloth, placed as it starts [m]
/// @param triangles  [triangles] of rest's polygons
void apply_pattern(const scene::Cloth& cloth, const ObjMesh& rest, const std::vector<Triangle>& triangles,
                   preview::RenderMesh& mesh);

} // namespace toile::app
