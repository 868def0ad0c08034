#pragma once

#include <memory>
#include <vector>

#include "collision/geometry/surface_edges.h"
#include "core/compute/types.h"

namespace toile::research::near_pairs {

/// Embree's search of a scene against itself: rtcCollide over the triangles as user geometry, each with a box
/// grown by half the margin. Finds the same pairs as NearPairs.
class ByCollide {
public:
    ByCollide(View<const Triangle> triangles, View<const Vec3> positions);
    ~ByCollide();
    ByCollide(const ByCollide&) = delete;
    ByCollide& operator=(const ByCollide&) = delete;

    /// Number of pairs of primitives without a common vertex at most `margin` [m] apart. Each is counted
    /// once, at the lowest triangles of both.
    size_t find(View<const Vec3> x, double margin);

    /// Embree's part of find(): new boxes, and the number of proposed pairs of triangles, each from both
    /// sides.
    size_t find_candidates(View<const Vec3> x, double margin);

private:
    class Scene;
    struct Found {
        int first, second;
    };
    struct Search;

    bool is_own_vertex(int v, int t) const { return edges_.corners_of_vertex.of(v)[0] / 3 == t; }
    bool is_own_edge(int e, int t) const { return edges_.triangles.of(e)[0] == t; }
    void find_between(int s, int t, double margin, std::vector<Found>& out) const;
    void find_vertices(int s, int t, double margin, std::vector<Found>& out) const;
    void find_edges(int s, int t, double margin, std::vector<Found>& out) const;

    std::vector<Triangle> triangles_;
    collision::SurfaceEdges edges_;
    std::vector<Vec3> x_; ///< [vertices] of the search [m]
    std::vector<Found> found_;
    std::unique_ptr<Scene> scene_;
};

} // namespace toile::research::near_pairs
