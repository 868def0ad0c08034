#pragma once

#include <string>
#include <vector>

#include "export/cache_layout.h"
#include "export/gltf/principal_shapes.h"

namespace toile::exports {

/// Contents of a binary glTF 2.0 file: a node and a mesh for each mesh of the layout, in metres with Y up.
/// The shapes are morph targets of positions, which all meshes share, and an animation gives them weights,
/// linear between frames, from 0 s on. Polygons are triangles, vertices at seams of the texture are several,
/// and normals are those of the first frame, which the meshes' own weights show. The attribute _VERTEX of
/// each is its number in the cache.
/// @param layout     positions are ignored
/// @param max_error  [m] stored in the file's asset.extras
/// @throws InvalidInput naming the file if it would be larger than the format allows, 4 GiB
std::string glb_bytes(const std::string& file, const CacheLayout& layout, const ShapeAnimation& animation,
                      double max_error);

} // namespace toile::exports
