#pragma once

#include <vector>

#include "core/compute/types.h"
#include "core/mesh/obj.h"
#include "export/corner_normals.h"

namespace toile::exports {

/// Cloth of a thickness: its upper side, its lower side, and a rim of quads along its borders. The vertices
/// of the upper side come first, then those of the lower side, both in the order of the cloth.
class ClosedSurface {
public:
    /// @param faces      polygons, texture coordinates and groups of the cloth
    /// @param thickness  [vertices] [m]
    ClosedSurface(const ObjMesh& faces, std::vector<double> thickness);

    const ObjMesh& faces() const { return faces_; }

    /// [2 x vertices] positions, half a thickness along the normal on either side of the cloth's.
    std::vector<Vec3> positions(View<const Vec3> cloth) const;

    /// [vertices] positions of the cloth between the sides, up to rounding.
    static std::vector<Vec3> middle(View<const Vec3> positions);

private:
    void add_lower_side();
    void add_rim();

    ObjMesh faces_;
    std::vector<double> thickness_;
    CornerNormals normals_;
    std::vector<int> normal_of_; ///< [vertices] index of its normal; -1: it has no face
};

} // namespace toile::exports
