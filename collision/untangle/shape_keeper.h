#pragma once

#include <array>
#include <vector>

#include "collision/untangle/joined_cloths.h"

namespace toile {

/// Brings moved cloth back towards its shape at the start: lengths of edges, and across every edge the
/// distance of the two corners opposite to it, which keeps the bend. Position-based projections in the order
/// of the edges [Mueller et al. 2007, section 3.3], so the result has the same bits for every thread count.
class ShapeKeeper {
public:
    /// @param cloths  must outlive this
    explicit ShapeKeeper(const JoinedCloths& cloths);

    /// @param x       [vertices] [m]
    /// @param sweeps  over all constraints; each spreads a stretch by about an edge
    void relax(View<Vec3> x, int sweeps) const;

    /// Lets the surface at these vertices tend to be flat instead of bent as at the start: a fold that goes
    /// through itself there has to open.
    /// @param patch  [vertices] nonzero for those
    void unfold(const std::vector<char>& patch);

private:
    struct Distance {
        std::array<int, 2> vertex;
        double length;    ///< [m]
        double stiffness; ///< share of the error that one sweep removes [-]
    };

    void project(const Distance& distance, View<Vec3> x) const;

    const JoinedCloths& cloths_;
    std::vector<Distance> lengths_; ///< [edges]
    std::vector<Distance> bends_;
    std::vector<double> flat_; ///< [bends] their length in the plane [m]
};

/// Strain of the cloths' edges relative to the start.
struct EdgeStrain {
    double max = 0.0; ///< [-] largest |length / start length - 1|
    double rms = 0.0; ///< [-]
    int edge = -1;    ///< of the largest
};
EdgeStrain edge_strain(const JoinedCloths& cloths, View<const Vec3> x);

} // namespace toile
