#pragma once

#include <array>
#include <vector>

#include "core/backend/types.h"

namespace toile {

/// Edges of cloth that take their other end along where one is stopped: none gets longer than it was or was
/// to get, whichever is more, and a slack. Slivers keep their length, or they would be stretched a
/// hundredfold.
class Tethers {
public:
    using Edge = std::array<int, 2>;

    explicit Tethers(std::vector<Edge> edges) : edges_(std::move(edges)) {}

    /// @param base   [vertices] a pose [m]; borrowed until the next begin()
    /// @param ways   [vertices] from there to where they want to go [m]
    /// @param slack  [m]
    void begin(View<const Vec3> base, View<const Vec3> ways, double slack);

    const std::vector<Edge>& edges() const { return edges_; }

    /// True for an edge shorter than the slack: its ends are one point to all that is as coarse.
    bool is_sliver(int edge) const;

    /// True when an edge is too long where its ends go by `motion` [vertices] [m].
    bool is_torn(int edge, View<const Vec3> motion) const;

    /// The largest share [-] that the ends of a torn edge may keep of what their motions differ by.
    double share(int edge, View<const Vec3> motion) const;

private:
    std::vector<Edge> edges_;
    View<const Vec3> base_;
    double slack_ = 0.0;           ///< [m]
    std::vector<double> longest2_; ///< [edges] square of the length allowed [m^2]
};

} // namespace toile
