#pragma once

#include "apps/render/render_scene.h"
#include "core/mesh/obj.h"
#include "scenes/format/scene.h"

namespace toile {

/// Linear RGB of an sRGB colour, both in [0, 1].
Vec3 linear_color(const Vec3& srgb);

/// Puts the cloth's pattern on a picture's mesh, in metres of the cloth: over the file's texture coordinates,
/// the plane of a flat cut, or around a skirt. Cloth without any of these stays plain.
/// @param rest       the unstretched cloth, placed as it starts [m]
/// @param triangles  [triangles] fans of rest's polygons
void apply_pattern(const scene::Cloth& cloth, const ObjMesh& rest, const std::vector<Triangle>& triangles,
                   RenderMesh& mesh);

} // namespace toile
