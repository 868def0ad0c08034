#pragma once

#include <filesystem>

#include "avatars/model/appearance.h"

namespace toile::avatars {

/// Reads the colours of a Wavefront OBJ body, on the triangles of read_obj(): materials of its .mtl files
/// (Kd, map_Kd, map_d) and colours of vertices (v x y z r g b), which are sRGB. An image replaces Kd, which
/// many programs write as black beside it.
/// @throws InvalidInput as read_obj(). Missing .mtl files and images are told in `left_out`.
Appearance import_obj_appearance(const std::filesystem::path& file);

} // namespace toile::avatars
