#pragma once

#include <vector>

#include "collision/untangle/body_distance.h"
#include "collision/untangle/joined_cloths.h"
#include "collision/untangle/shape_keeper.h"

namespace toile {

/// A point of cloth inside a body: a vertex, the centroid of a triangle or the midpoint of an edge.
struct InsideSample {
    std::array<int, 3> vertex{-1, -1, -1}; ///< one, two or three of the cloth's, equally weighted
    Vec3 point = Vec3::Zero();             ///< [m]
    BodyPlace place;
};

/// Brings cloth out of bodies that grow back from where the cloth is outside.
class BodyClearing {
public:
    /// @param cloths  must outlive this, as must the bodies
    BodyClearing(const JoinedCloths& cloths, std::vector<ContactPartner> bodies);

    /// Vertices, centroids and midpoints deeper than `depth` [m] in a body, held ones too.
    std::vector<InsideSample> inside(View<const Vec3> x, double depth) const;

    /// Lets the bodies grow: every increment carries all cloth near what is inside outwards, the deepest most
    /// and layers in their order, and lets it relax. Returns the increments taken.
    int grow(View<Vec3> x, const ShapeKeeper& keeper) const;

    /// Moves what is nearer to a body than its gap out to it, without carrying anything along.
    void push(View<Vec3> x) const;

    /// Moves faces of cloth out of which a body's vertex pokes between their samples.
    void push_off_tips(View<Vec3> x) const;

private:
    enum class Limit { Surface, Gap };
    InsideSample sample_at(View<const Vec3> x, int index) const;
    bool can_move(const InsideSample& sample) const;
    std::vector<InsideSample> movable_below(View<const Vec3> x, Limit limit) const;
    template <typename Least>
    std::vector<InsideSample> samples_below(View<const Vec3> x, const Least& least) const;
    void carry(View<Vec3> x, const std::vector<InsideSample>& inside, double share) const;

    const JoinedCloths& cloths_;
    std::vector<ContactPartner> bodies_;
};

} // namespace toile
