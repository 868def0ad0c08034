#pragma once

#include <vector>

#include "collision/surface_proximity.h"

namespace toile::near_pairs {

/// What NearPairs replaces: one query of Embree's tree per vertex and per edge. Finds the same pairs.
class ByPointQueries {
public:
    ByPointQueries(View<const Triangle> triangles, View<const Vec3> positions);

    /// Pairs of primitives without a common vertex at most `margin` [m] apart; how many there are.
    size_t find(View<const Vec3> x, double margin);

private:
    struct Found {
        int first, second;
    };
    void find_triangles(int v, double margin, std::vector<Found>& out) const;
    void find_edges(int e, double margin, std::vector<Found>& out) const;

    SurfaceProximity surface_;
    std::vector<Found> found_;
};

} // namespace toile::near_pairs
