#pragma once

#include <vector>

#include "collision/geometry/surface_proximity.h"

namespace toile::research::near_pairs {

/// Alternative to NearPairs: one query of Embree's tree per vertex and per edge. Finds the same pairs.
class ByPointQueries {
public:
    ByPointQueries(View<const Triangle> triangles, View<const Vec3> positions);

    /// Number of pairs of primitives without a common vertex at most `margin` [m] apart.
    size_t find(View<const Vec3> x, double margin);

private:
    struct Found {
        int first, second;
    };
    void find_triangles(int v, double margin, std::vector<Found>& out) const;
    void find_edges(int e, double margin, std::vector<Found>& out) const;

    collision::SurfaceProximity surface_;
    std::vector<Found> found_;
};

} // namespace toile::research::near_pairs
