#pragma once

#include <string>
#include <vector>

#include "core/mesh/obj.h"
#include "core/mesh/topology.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::garment {

/// Undeformed cloth, triangle by triangle, in material axes: u along the warp, v along the weft.
///
/// The energies depend only on edge lengths and the grain direction of each triangle. A flat pattern, a set
/// of sewn panels and a garment modelled in 3-D are therefore equivalent to them.
struct RestShape {
    std::vector<Triangle> triangles; ///< [triangles]
    std::vector<Mat2> edges;         ///< [triangles] columns x1 - x0, x2 - x0 in (u, v) [m]
    std::vector<Mat2> edges_inv;     ///< [triangles] inverse of edges [1/m]
    std::vector<double> areas;       ///< [triangles] [m^2]
    Topology topology;

    int vertex_count() const
    {
        return topology.corners_of_vertex.first.empty() ? 0
                                                        : int(topology.corners_of_vertex.first.size()) - 1;
    }

    /// F_t [-]: maps rest edges of a triangle to its edges at x [vertices] [m].
    Mat32 deformation_gradient(int triangle, View<const Vec3> x) const
    {
        const Triangle& corner = triangles[triangle];
        Mat32 now;
        now.col(0) = x[corner[1]] - x[corner[0]];
        now.col(1) = x[corner[2]] - x[corner[0]];
        return now * edges_inv[triangle];
    }

    /// True if the longest edge is over a hundred times its altitude. The strain across such a triangle is
    /// noise of its neighbours' motion. The strain along it is theirs too, so limits on them suffice.
    bool is_sliver(int triangle) const;

    /// Lumped vertex areas: a third of every adjacent triangle [m^2].
    std::vector<double> vertex_areas() const;
};

/// Some triangles of a rest shape, with all its vertices.
/// @param triangles  ascending
RestShape part_of(const RestShape& rest, const std::vector<int>& triangles);

/// Rest shape of a flat pattern.
/// @param uv  [vertices] pattern coordinates in material axes [m]
/// @throws InvalidInput naming `source` and the first unusable triangle or edge (require_usable,
/// build_topology).
RestShape rest_shape_of_pattern(const std::vector<Vec2>& uv, const std::vector<Triangle>& triangles,
                                const std::string& source);

/// Rest shape of a surface in space; every triangle is flattened individually.
/// @param grain     direction that the warp follows, projected onto each triangle; triangles perpendicular to
///                  it use the next coordinate axis
/// @param rotation  angle [rad] by which the warp is then rotated in the cloth, counter-clockwise seen from
///                  outside
RestShape rest_shape_of_surface(const TriangleMesh& mesh, const Vec3& grain, double rotation,
                                const std::string& source);

/// Rest shape of a surface in space whose triangles lie flat in panels, as sewn garments have. Triangles that
/// meet in a vertex or at an edge of the surface may lie anywhere in the plane.
/// @param panels    [triangles] corners of each in its panel, x right and y up [m]; mirrored ones may be
///                  clockwise
/// @param rotation  angle [rad] of the warp from the panels' y axis, counter-clockwise in their plane
RestShape rest_shape_of_panels(const TriangleMesh& mesh, const std::vector<FlatTriangle>& panels,
                               double rotation, const std::string& source);

} // namespace toile::garment
