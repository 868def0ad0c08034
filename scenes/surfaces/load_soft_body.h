#pragma once

#include <string>

#include "scenes/format/scene.h"
#include "scenes/surfaces/cloth_state.h"
#include "volume/mesh/tet_mesh.h"

namespace toile::scenes {

/// A soft body at its start placement.
struct LoadedSoftBody {
    std::string source;   ///< name in errors
    ClothState surface;   ///< its vertices are the first of the mesh
    volume::TetMesh mesh; ///< [m]
};

/// @throws InvalidInput for an unusable mesh
LoadedSoftBody load_soft_body(const scene::SoftBody& body);

} // namespace toile::scenes
