#pragma once

#include <vector>

#include "collision/repair/body_distance.h"
#include "collision/repair/joined_cloths.h"
#include "collision/repair/shape_keeper.h"

namespace toile::collision {

/// Point of cloth inside a body: a vertex, the centroid of a triangle or the midpoint of an edge.
struct InsideSample {
    std::array<int, 3> vertex{-1, -1, -1}; ///< one, two or three vertices of the cloth, equally weighted
    Vec3 point = Vec3::Zero();             ///< [m]
    BodyProximity proximity;
};

/// Moves cloth out of bodies, which are grown from where the cloth is outside.
class BodyClearing {
public:
    /// @param cloths  must outlive this, as must the bodies
    BodyClearing(const JoinedCloths& cloths, std::vector<ContactCollider> bodies);

    /// Vertices, centroids and midpoints deeper than `depth` [m] in a body, including those of fixed
    /// vertices.
    std::vector<InsideSample> inside(View<const Vec3> x, double depth) const;

    /// Grows the bodies: every increment advects all cloth near inside samples outwards, the deepest most and
    /// layers in their order, then relaxes it. Returns the number of increments.
    int grow(View<Vec3> x, const ShapeKeeper& keeper) const;

    /// Moves samples nearer to a body than their gap out to the gap, without moving cloth around them.
    void project(View<Vec3> x) const;

    /// Moves faces of cloth off body vertices that pierce them between their samples.
    void project_off_tips(View<Vec3> x) const;

private:
    enum class Limit { Surface, Gap };
    InsideSample sample_at(View<const Vec3> x, int index) const;
    bool can_move(const InsideSample& sample) const;
    std::vector<InsideSample> movable_below(View<const Vec3> x, Limit limit) const;
    template <typename Bound>
    std::vector<InsideSample> samples_below(View<const Vec3> x, const Bound& bound) const;
    void displace(View<Vec3> x, const std::vector<InsideSample>& inside, double fraction) const;

    const JoinedCloths& cloths_;
    std::vector<ContactCollider> bodies_;
};

} // namespace toile::collision
