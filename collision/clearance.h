#pragma once

#include <vector>

#include "collision/colliders.h"

namespace toile {

/// How far each cloth vertex is in front of a mesh, at least: what an earlier search has found, less what
/// both have moved since. While that is more than a search looks for, the search can be left out.
class Clearance {
public:
    explicit Clearance(int vertex_count)
        : x_(vertex_count, Vec3::Zero()), bound_(vertex_count, 0.0), nearest_(vertex_count, -1)
    {
    }

    /// To the present positions of cloth [vertices] [m] and mesh. O(vertices).
    void follow(View<const Vec3> x, const MeshCollider& mesh);

    /// [m] No surface is nearer, and the vertex is not inside; 0 where that is not known.
    double of(int vertex) const { return bound_[vertex]; }

    View<const double> bounds() const { return bound_; } ///< [vertices] of() of each [m]

    /// True where no surface is within `radius` [m] of any point of an edge: its ends are clear by more than
    /// the radius and half of it.
    bool is_edge_clear(int a, int b, double radius) const
    {
        const double most = bound_[a] + bound_[b] - 2.0 * radius;
        return most > 0.0 && most * most > (x_[a] - x_[b]).squaredNorm();
    }

    /// The triangle that the last search found nearest, or -1: a hint for the next.
    int nearest(int vertex) const { return nearest_[vertex]; }

    /// A search has found the vertex this far in front [m]; 0: inside.
    /// @param triangle  the nearest; -1: none
    void learn(int vertex, double distance, int triangle);

private:
    std::vector<Vec3> x_;       ///< [vertices] that the bounds are for [m]
    std::vector<double> bound_; ///< [vertices] [m]
    std::vector<int> nearest_;  ///< [vertices] triangle
    int move_count_ = -2;       ///< of the mesh, likewise; -2: of none
};

} // namespace toile
