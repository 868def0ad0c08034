#pragma once

#include "core/mesh/obj.h"
#include "garment/pattern/mesh/pattern_mesh.h"

namespace toile::garment {

/// Panels of a pattern, flat in space by Panel::placement, before sewing [m]. Vertices and triangles are
/// those of the mesh, and so are its normals: away from the body. Texture coordinates are `uv` [m], one for
/// each vertex; each panel is a group, and each stitch a line.
ObjMesh placed_panels(const Pattern& pattern, const PatternMesh& mesh);

} // namespace toile::garment
