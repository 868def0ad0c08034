#pragma once

#include <variant>
#include <vector>

#include "collision/body/detect.h"
#include "collision/geometry/shape_rules.h"

namespace toile::collision {

/// Calls visit(MovingSolid) with the solid of a collider.
template <typename Visit>
void with_solid(const ShapeCollider& shape, const Visit& visit)
{
    std::visit(
        [&](const auto& solid) {
            visit(MovingSolid<std::decay_t<decltype(solid)>>{solid, solid_pose(shape.pose_t0()),
                                                             solid_pose(shape.pose())});
        },
        shape.shape());
}

/// Search for pairs of faces and edges of one cloth with the corners and edges of one solid.
class ShapeSearch {
public:
    /// @param cloth     its triangles and edges are read, not its tree
    /// @param x         [vertices] cloth positions [m]
    /// @param skeleton  the solid's, at t1
    /// @param collider  the solid's number
    /// @param radius    [m] points closer than this become pairs
    ShapeSearch(const SurfaceProximity& cloth, View<const Vec3> x, const ShapeCollider& shape,
                const ShapeSkeleton& skeleton, int collider, double radius);

    /// Appends pairs of cloth faces and corners, by cloth face, then by corner.
    void find_faces(std::vector<ContactPair>& out) const;

    /// Appends pairs of cloth edges with corners and edges, by cloth edge, then by feature.
    void find_edges(std::vector<ContactPair>& out) const;

private:
    template <typename Solid>
    ShapeRules<Solid> rules_of(const MovingSolid<Solid>& solid) const;

    const SurfaceProximity& cloth_;
    View<const Vec3> x_;
    const ShapeCollider& shape_;
    PlainSkeleton skeleton_;
    int collider_;
    double radius_;
    std::vector<double> distance_; ///< [vertices] to the skeleton [m]
};

} // namespace toile::collision
