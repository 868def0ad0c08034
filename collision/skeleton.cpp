#include "collision/skeleton.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/distance.h"

namespace toile {

namespace {

/// The corner number of a box: bit k tells the side along axis k.
Skeleton box_skeleton(const Vec3& half, const Eigen::Isometry3d& pose)
{
    const auto side = [](int corner, int axis) { return (corner >> axis & 1) != 0 ? 1.0 : -1.0; };
    Skeleton box;
    for (int c = 0; c < 8; ++c) {
        Skeleton::Corner corner;
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
                const Skeleton::Corner& low = box.corners[c];
                box.edges.push_back({low.point,
                                     box.corners[c | 1 << axis].point,
                                     {low.faces[(axis + 1) % 3], low.faces[(axis + 2) % 3]}});
            }
    return box;
}

} // namespace

double Skeleton::distance(const Vec3& x) const
{
    double squared = std::numeric_limits<double>::infinity();
    for (const Corner& corner : corners)
        squared = std::min(squared, (x - corner.point).squaredNorm());
    for (const Edge& edge : edges) {
        const double t = closest_on_segment(x, edge.a, edge.b);
        squared = std::min(squared, (x - edge.a - t * (edge.b - edge.a)).squaredNorm());
    }
    return std::sqrt(squared) - radius;
}

std::vector<Vec3> Skeleton::points() const
{
    std::vector<Vec3> points;
    for (const Corner& corner : corners)
        points.push_back(corner.point);
    return points;
}

Skeleton skeleton_of(const Shape& shape, const Eigen::Isometry3d& pose)
{
    Skeleton round;
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

} // namespace toile
