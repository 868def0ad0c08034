#pragma once

#include <vector>

#include "collision/body/colliders.h"

namespace toile::collision {

/// Lower bounds on the distance of each cloth vertex in front of a mesh. A bound is the result of an earlier
/// search minus the motion of both since. A search with a reach below the bound can be skipped.
class Clearance {
public:
    explicit Clearance(int vertex_count)
        : x_(vertex_count, Vec3::Zero()), bound_(vertex_count, 0.0), nearest_(vertex_count, -1)
    {
    }

    /// Updates the bounds to the present positions of cloth [vertices] [m] and mesh. O(vertices).
    void follow(View<const Vec3> x, const MeshCollider& mesh);

    /// Distance [m] within which there is no surface, for a vertex outside the mesh; 0 if unknown.
    double of(int vertex) const { return bound_[vertex]; }

    View<const double> bounds() const { return bound_; } ///< [vertices] of() of each [m]

    /// True if no surface lies within `radius` [m] of any point of an edge: the clearances of its ends beyond
    /// `radius` sum to more than its length.
    bool is_edge_clear(int a, int b, double radius) const
    {
        const double max_distance = bound_[a] + bound_[b] - 2.0 * radius;
        return max_distance > 0.0 && max_distance * max_distance > (x_[a] - x_[b]).squaredNorm();
    }

    /// Triangle nearest in the last search, or -1: a hint for the next search.
    int nearest(int vertex) const { return nearest_[vertex]; }

    /// Records a search result: the vertex is this far in front of the mesh [m]; 0: inside.
    /// @param triangle  nearest triangle; -1: none
    void record(int vertex, double distance, int triangle);

private:
    std::vector<Vec3> x_;       ///< [vertices] positions of the bounds [m]
    std::vector<double> bound_; ///< [vertices] [m]
    std::vector<int> nearest_;  ///< [vertices] nearest triangle
    int move_count_ = -2;       ///< mesh's move_count() at the bounds; -2: none
};

} // namespace toile::collision
