#pragma once

#include <array>
#include <vector>

#include "core/backend/types.h"
#include "core/mesh/topology.h"

namespace toile {

/// Edges of cloth that take their other end along where one is stopped: none gets longer than it was or was
/// to get, whichever is more, and a slack. Slivers keep their length, or they would be stretched a
/// hundredfold.
class Tethers {
public:
    using Edge = std::array<int, 2>;

    Tethers(std::vector<Edge> edges, int vertex_count);

    /// @param base   [vertices] a pose [m]; borrowed until the next begin()
    /// @param ways   [vertices] from there to where they want to go [m]; borrowed likewise
    /// @param slack  [m]
    void begin(View<const Vec3> base, View<const Vec3> ways, double slack);

    const std::vector<Edge>& edges() const { return edges_; }

    /// Replaces `torn` by the edges around some vertices that are too long where their ends go by `motion`
    /// [vertices] [m]. Ascending.
    void find_torn(View<const int> vertices, View<const Vec3> motion, std::vector<int>& torn) const;

    /// True for an edge shorter than the slack: its ends are one point to all that is as coarse.
    bool is_sliver(int edge) const;

    /// The largest share [-] that the ends of a torn edge may keep of what their motions differ by.
    double share(int edge, View<const Vec3> motion) const;

    /// The largest share [-] of what its way differs from `common` [m] that the end `last` of an edge may
    /// keep where the other end keeps less, `least`: not below that, for where both keep the same the edge
    /// is nowhere longer than at the longer of start and end. Not for slivers.
    double share_behind(int edge, int last, const Vec3& common, double least) const;

private:
    bool is_torn(int edge, View<const Vec3> motion) const;
    double longest2(int edge) const;

    std::vector<Edge> edges_;
    Incidence of_vertex_; ///< edges
    View<const Vec3> base_, ways_;
    double slack_ = 0.0; ///< [m]
};

} // namespace toile
