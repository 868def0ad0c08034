#pragma once

#include <array>
#include <vector>

#include "core/compute/types.h"
#include "core/mesh/topology.h"

namespace toile::collision {

/// Limits the length of cloth edges if one end is stopped: the other end follows. The limit is the larger of
/// the lengths at the start and at the requested end, plus a slack. Slivers keep their length, or the slack
/// would stretch them a hundredfold.
class EdgeStretchLimiter {
public:
    using Edge = std::array<int, 2>;

    EdgeStretchLimiter(std::vector<Edge> edges, int vertex_count);

    /// @param base   [vertices] start pose [m]; borrowed until the next begin()
    /// @param displacements   [vertices] requested, from base [m]; borrowed likewise
    /// @param slack  [m]
    void begin(View<const Vec3> base, View<const Vec3> displacements, double slack);

    const std::vector<Edge>& edges() const { return edges_; }

    /// Replaces `overstretched` by the edges around `vertices` that are too long after `motion` [vertices]
    /// [m], ascending.
    void find_overstretched(View<const int> vertices, View<const Vec3> motion,
                            std::vector<int>& overstretched) const;

    /// True for an edge shorter than the slack: its ends coincide at that resolution.
    bool is_sliver(int edge) const;

    /// Largest fraction [-] of the difference of their motions that the ends of an overstretched edge may
    /// keep.
    double fraction(int edge, View<const Vec3> motion) const;

    /// Largest fraction [-] of its displacement's deviation from `common` [m] that end `last` of an edge may
    /// keep. The other end keeps less, `min_fraction`. The result is not below that: at equal fractions an
    /// edge is never longer than the longer of start and end. Not for slivers.
    double trailing_fraction(int edge, int last, const Vec3& common, double min_fraction) const;

private:
    bool is_overstretched(int edge, View<const Vec3> motion) const;
    double longest2(int edge) const;

    std::vector<Edge> edges_;
    Incidence of_vertex_; ///< edges
    View<const Vec3> base_, displacements_;
    double slack_ = 0.0; ///< [m]
};

} // namespace toile::collision
