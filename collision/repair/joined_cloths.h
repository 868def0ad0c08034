#pragma once

#include <array>
#include <vector>

#include "collision/geometry/surface_edges.h"
#include "collision/repair/start_cloth.h"
#include "core/compute/types.h"

namespace toile::collision {

/// All cloths of a start pose as one surface, with quantities precomputed for the repair.
///
/// A piece is a part connected by triangles: the shirt and the trousers of one file are two pieces.
struct JoinedCloths {
    explicit JoinedCloths(const std::vector<StartCloth>& cloths);

    std::vector<Triangle> triangles;
    std::vector<Vec3> start;       ///< [vertices] [m]
    std::vector<char> fixed;       ///< [vertices]
    std::vector<double> gap;       ///< [vertices] to keep from bodies [m]
    std::vector<double> thickness; ///< [vertices] [m]
    std::vector<int> cloth;        ///< [vertices]
    std::vector<int> first_vertex; ///< [cloths + 1]
    std::vector<int> piece;        ///< [vertices] -1 for a vertex without a triangle
    std::vector<int> given_layer;  ///< [pieces] that of its cloth
    std::vector<int> layer;        ///< [pieces] likewise, or a finer order
    SurfaceEdges edges;
    std::vector<std::array<int, 2>> opposite; ///< [edges] third corners of its two triangles; -1: border
    std::vector<double> length;               ///< [edges] at the start [m]
    double mean_length = 0.0;                 ///< [m]

    int vertex_count() const { return int(start.size()); }
    int piece_count() const { return int(layer.size()); }
};

} // namespace toile::collision
