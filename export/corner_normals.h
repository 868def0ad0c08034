#pragma once

#include <vector>

#include "core/compute/types.h"
#include "core/mesh/obj.h"

namespace toile::exports {

/// Unit normals of a mesh for shading: means over the faces at a vertex, weighted by area. Corners with other
/// texture coordinates have a normal of their own, so that seams between panels are creased.
class CornerNormals {
public:
    /// @param faces  polygons, and texture coordinates if it has them
    explicit CornerNormals(const ObjMesh& faces);

    /// Index of the normal at each corner, polygon by polygon.
    const std::vector<std::vector<int>>& indices() const { return indices_; }

    /// Normals of positions; zero where all faces of a vertex have no area.
    std::vector<Vec3> at(View<const Vec3> positions) const;

private:
    std::vector<std::vector<int>> polygons_, indices_;
    int count_ = 0;
};

} // namespace toile::exports
