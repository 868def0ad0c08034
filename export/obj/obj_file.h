#pragma once

#include "export/cache_layout.h"
#include "export/sequence/mesh_files.h"

namespace toile::exports {

/// Writes OBJ files with the polygons, texture coordinates and groups of a layout of one mesh.
MeshFileWriter obj_file_writer(const CacheLayout& layout);

} // namespace toile::exports
