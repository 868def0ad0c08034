#pragma once

#include <limits>
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

    struct Attachment {
        std::vector<int> vertices;
        double release = std::numeric_limits<double>::infinity(); ///< [s]
    };
    std::vector<Attachment> attachments;

    /// [vertices] 1 for those that are attached at time t [s].
    std::vector<unsigned char> attached(double t) const
    {
        std::vector<unsigned char> attached(rest.positions.size(), 0);
        for (const Attachment& attachment : attachments)
            if (t < attachment.release)
                for (const int v : attachment.vertices)
                    attached[v] = 1;
        return attached;
    }
};

} // namespace toile::scenes
