#pragma once

#include <string>
#include <vector>

#include "core/mesh/obj.h"

namespace toile::exports {

/// A group of a mesh's faces as a mesh of its own.
struct MeshPart {
    std::string name;          ///< of the group; "other" for faces without one
    std::vector<int> vertices; ///< of the whole mesh, ascending
    ObjMesh faces;             ///< polygons of those, by their places in `vertices`
};

/// The groups of a mesh that have faces, in the order of face_panels().
/// @param faces  polygons, texture coordinates and groups; positions are ignored
std::vector<MeshPart> parts_of(const ObjMesh& faces);

} // namespace toile::exports
