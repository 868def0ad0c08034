#pragma once

#include <string>
#include <vector>

#include "core/mesh/obj.h"
#include "garment/fabric/fabric.h"

namespace toile::scenes {

/// Public state of a cloth of a running scene, or of the surface of a solid.
struct ClothState {
    std::string name;
    std::vector<Vec3> positions; ///< [vertices] current [m]
    std::vector<Triangle> triangles;
    ObjMesh rest;           ///< start placement, rest lengths, faces and texture coordinates as stored
    garment::Fabric fabric; ///< of a solid: none, and a strain limit of 0
    int flipped_faces = 0;  ///< faces of the file wound against their neighbours, corrected in `rest`
};

} // namespace toile::scenes
