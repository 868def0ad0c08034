#include "collision/body/shape_search.h"

#include "core/compute/parallel.h"

namespace toile::collision {

ShapeSearch::ShapeSearch(const SurfaceProximity& cloth, View<const Vec3> x, const ShapeCollider& shape,
                         const ShapeSkeleton& skeleton, int collider, double radius)
    : cloth_(cloth), x_(x), shape_(shape), skeleton_(plain(skeleton)), collider_(collider), radius_(radius),
      distance_(x.size())
{
    parallel_for(kCpu, "collision/shape_distance", x.size(),
                 [&](int v) { distance_[v] = skeleton_.distance(x_[v]); });
}

template <typename Solid>
ShapeRules<Solid> ShapeSearch::rules_of(const MovingSolid<Solid>& solid) const
{
    const SurfaceView& cloth = cloth_.view();
    return {cloth.triangles, cloth.edges, x_, solid, skeleton_, distance_, collider_, radius_};
}

void ShapeSearch::find_faces(std::vector<ContactPair>& out) const
{
    with_solid(shape_, [&](const auto& solid) {
        const auto rules = rules_of(solid);
        parallel_append(
            kCpu, "collision/shape_faces", rules.triangles.size(),
            [&](int begin, int end, std::vector<ContactPair>& pairs) {
                for (int t = begin; t < end; ++t)
                    rules.visit_face(t, [&](const ContactPair& pair) { pairs.push_back(pair); });
            },
            out);
    });
}

void ShapeSearch::find_edges(std::vector<ContactPair>& out) const
{
    with_solid(shape_, [&](const auto& solid) {
        const auto rules = rules_of(solid);
        parallel_append(
            kCpu, "collision/shape_edges", rules.edges.vertex.size(),
            [&](int begin, int end, std::vector<ContactPair>& pairs) {
                for (int e = begin; e < end; ++e)
                    rules.visit_edge(e, [&](const ContactPair& pair) { pairs.push_back(pair); });
            },
            out);
    });
}

} // namespace toile::collision
