#include "collision/geometry/shape_skeleton.h"

#include <algorithm>

#include "collision/geometry/shape_rules.h"

namespace toile::collision {

namespace {

/// Skeleton of a box. Bit k of a corner's number is its side along axis k.
ShapeSkeleton box_skeleton(const Vec3& half, const Eigen::Isometry3d& pose)
{
    const auto side = [](int corner, int axis) { return (corner >> axis & 1) != 0 ? 1.0 : -1.0; };
    ShapeSkeleton box;
    for (int c = 0; c < 8; ++c) {
        ShapeSkeleton::Corner corner;
        const Vec3 signs(side(c, 0), side(c, 1), side(c, 2));
        corner.point = pose * signs.cwiseProduct(half);
        for (int k = 0; k < 3; ++k)
            corner.faces[k] = signs[k] * pose.linear().col(k);
        box.corners.push_back(corner);
    }

    // Edges along an axis start at the corners on its lower side.
    for (int axis = 0; axis < 3; ++axis)
        for (int c = 0; c < 8; ++c)
            if ((c >> axis & 1) == 0) {
                const ShapeSkeleton::Corner& low = box.corners[c];
                box.edges.push_back({low.point,
                                     box.corners[c | 1 << axis].point,
                                     {low.faces[(axis + 1) % 3], low.faces[(axis + 2) % 3]}});
            }
    return box;
}

} // namespace

PlainSkeleton plain(const ShapeSkeleton& skeleton)
{
    PlainSkeleton made{};
    TOILE_ASSERT(skeleton.corners.size() <= made.corners.size() &&
                 skeleton.edges.size() <= made.edges.size());
    std::copy(skeleton.corners.begin(), skeleton.corners.end(), made.corners.begin());
    std::copy(skeleton.edges.begin(), skeleton.edges.end(), made.edges.begin());
    made.corner_count = int(skeleton.corners.size());
    made.edge_count = int(skeleton.edges.size());
    made.radius = skeleton.radius;
    return made;
}

double ShapeSkeleton::distance(const Vec3& x) const { return plain(*this).distance(x); }

std::vector<Vec3> ShapeSkeleton::points() const
{
    std::vector<Vec3> points;
    for (const Corner& corner : corners)
        points.push_back(corner.point);
    return points;
}

ShapeSkeleton skeleton_of(const Shape& shape, const Eigen::Isometry3d& pose)
{
    ShapeSkeleton round;
    if (const auto* sphere = std::get_if<SphereShape>(&shape)) {
        round.radius = sphere->radius;
        round.corners = {{pose.translation(), {}}};
    } else if (const auto* capsule = std::get_if<CapsuleShape>(&shape)) {
        round.radius = capsule->radius;
        const Vec3 half = capsule->half_length * pose.linear().col(1);
        round.corners = {{pose.translation() - half, {}}, {pose.translation() + half, {}}};
        round.edges = {{round.corners[0].point, round.corners[1].point, {}}};
    } else if (const auto* box = std::get_if<BoxShape>(&shape))
        return box_skeleton(box->half_extent, pose);
    return round;
}

} // namespace toile::collision
