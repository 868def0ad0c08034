#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenes/colliders/collider.h"
#include "scenes/format/scene.h"
#include "scenes/surfaces/cloth_state.h"
#include "scenes/surfaces/embedded_surface.h"
#include "volume/mesh/tet_mesh.h"

namespace toile::scenes {

/// Surface of a soft body for pictures and caches.
struct RenderSurface {
    ClothState state; ///< as placed
    EmbeddedSurface embedding;
};

/// A soft body and its start placement.
struct LoadedSoftBody {
    std::string source;          ///< name in errors
    ClothState surface;          ///< as placed; its vertices are the first of the mesh
    volume::TetMesh rest;        ///< [m] in its own axes: equal for bodies of one file and scale
    std::vector<Vec3> positions; ///< [vertices] as placed [m]
    std::vector<int> of_file;    ///< [vertices] their numbers, by those among the file's that tetrahedra use
    std::optional<RenderSurface> render;
};

/// Reads each file once, and fills each surface once.
/// @param colliders  at the start: those whose surfaces are filled, or more
/// @throws InvalidInput for an unusable mesh or surface, and a render surface that is not at its body
std::vector<LoadedSoftBody> load_soft_bodies(const std::vector<scene::SoftBody>& bodies,
                                             const std::vector<Collider>& colliders);

} // namespace toile::scenes
