#pragma once

#include <string>
#include <vector>

#include "core/mesh/obj.h"

namespace toile::exports {

/// Polygons of a group, wherever it begins anew.
struct FaceGroup {
    std::string name;       ///< as given
    std::string clean_name; ///< of no other group of the mesh
    std::vector<int> polygons;
};

/// Groups of a mesh that have a name and polygons, in the order of the mesh.
std::vector<FaceGroup> face_groups(const ObjMesh& mesh);

} // namespace toile::exports
