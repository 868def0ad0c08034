#pragma once

#include <array>
#include <vector>

#include "collision/repair/joined_cloths.h"

namespace toile::collision {

/// Restores the start shape of moved cloth: the lengths of edges, and across every edge the distance of the
/// two opposite corners, which preserves the bend. Position-based projections in the order of the edges
/// [Mueller et al. 2007, section 3.3], so the result has the same bits for every thread count.
class ShapeKeeper {
public:
    /// @param cloths  must outlive this
    explicit ShapeKeeper(const JoinedCloths& cloths);

    /// Projects all constraints `sweeps` times.
    /// @param x       [vertices] [m]
    /// @param sweeps  each propagates a stretch by about one edge
    void relax(View<Vec3> x, int sweeps) const;

    /// Sets the rest bend at these vertices to flat instead of the start shape, so that a fold that
    /// intersects itself opens.
    /// @param patch  [vertices] nonzero: unfolded
    void unfold(const std::vector<char>& patch);

private:
    struct Distance {
        std::array<int, 2> vertex;
        double length;    ///< [m]
        double stiffness; ///< fraction of the error that one sweep removes [-]
    };

    void project(const Distance& distance, View<Vec3> x) const;

    const JoinedCloths& cloths_;
    std::vector<Distance> lengths_; ///< [edges]
    std::vector<Distance> bends_;
    std::vector<double> flat_; ///< [bends] lengths in the flat state [m]
};

/// Strain of the cloths' edges relative to the start.
struct EdgeStrain {
    double max = 0.0; ///< [-] largest |length / start length - 1|
    double rms = 0.0; ///< [-]
    int edge = -1;    ///< edge of the maximum
};
EdgeStrain edge_strain(const JoinedCloths& cloths, View<const Vec3> x);

} // namespace toile::collision
