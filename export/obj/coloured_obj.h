#pragma once

#include <filesystem>

#include "core/mesh/triangle_mesh.h"

namespace toile::exports {

/// Writes a surface as OBJ with a colour behind each position, "v x y z r g b", an extension that MeshLab,
/// Blender and ZBrush read. Numbers have 9 significant digits, colours 4 decimals. The file appears complete
/// or not at all.
/// @param colours  [vertices] sRGB in [0, 1]
/// @throws InvalidInput or DeviceError as write_atomically() does
void write_coloured_obj(const std::filesystem::path& file, const TriangleMesh& mesh,
                        View<const Vec3> colours);

} // namespace toile::exports
