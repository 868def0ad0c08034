#pragma once

#include <array>
#include <vector>

#include "core/compute/types.h"
#include "core/mesh/topology.h"

namespace toile::collision {

/// Keeps the length of edges whose ends coincide at the resolution of contact, as of slivers: if one end is
/// stopped, the other follows. Without that, a deflection far longer than the edge would stretch it a
/// hundredfold.
class ShortEdges {
public:
    using Edge = std::array<int, 2>;

    /// @param edges  all of them; which are short depends on the pose
    ShortEdges(std::vector<Edge> edges, int vertex_count);

    /// @param base  [vertices] start pose [m]; borrowed until the next begin()
    /// @param resolution  [m] edges below this at the start are short
    void begin(View<const Vec3> base, double resolution);

    const std::vector<Edge>& edges() const { return edges_; }

    /// Replaces `overstretched` by the short edges around `vertices` that are too long after `motion`
    /// [vertices] [m], ascending.
    void find_overstretched(View<const int> vertices, View<const Vec3> motion,
                            std::vector<int>& overstretched) const;

    /// Largest fraction [-] of the difference of their motions that the ends of an overstretched edge may
    /// keep.
    double fraction(int edge, View<const Vec3> motion) const;

private:
    bool is_overstretched(int edge, View<const Vec3> motion) const;

    std::vector<Edge> edges_;
    Incidence of_vertex_; ///< edges
    View<const Vec3> base_;
    double resolution_ = 0.0; ///< [m]
};

} // namespace toile::collision
