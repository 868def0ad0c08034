#include "collision/body/cuda/detect.h"
#include "collision/body/shape_search.h"
#include "core/compute/cuda/parallel.cuh"

namespace toile::collision {

View<const ContactPair> DeviceContactDetector::detect(const ShapeCollider& shape, int collider)
{
    do
        search(shape, collider);
    while (!complete());
    return pairs_.view().subview(count_ - last_count_, last_count_);
}

void DeviceContactDetector::search(const ShapeCollider& shape, int collider)
{
    const PlainSkeleton skeleton = plain(skeleton_of(shape.shape(), shape.pose()));
    distance_.resize(x_.size());
    parallel_for(space_, "collision/device_skeleton", x_.size(),
                 MeasureSkeleton{x_, skeleton, distance_.view()});
    with_solid(shape, [&](const auto& solid) {
        using Solid = std::decay_t<decltype(solid.solid)>;
        search_solid(ShapeRules<Solid>{cloth_.triangles(), cloth_.edges(), x_, solid, skeleton,
                                       distance_.view(), collider, settings_.radius});
    });
}

/// Searches a solid; solids without corners form pairs with vertices only.
template <typename Solid>
void DeviceContactDetector::search_solid(const ShapeRules<Solid>& rules)
{
    const bool has_corners = rules.skeleton.corner_count > 0;
    const int vertices = x_.size();
    const int faces = has_corners && settings_.face_vertex ? rules.triangles.size() : 0;
    const int edges = has_corners && settings_.edge_edge ? rules.edges.vertex.size() : 0;
    counts_.resize(vertices + faces + edges + 1);
    first_.resize(counts_.size());
    counts_.fill_zero();
    count_pairs<ShapeQuery::kVertex>(rules, 0, vertices);
    count_pairs<ShapeQuery::kFace>(rules, vertices, faces);
    count_pairs<ShapeQuery::kEdge>(rules, vertices + faces, edges);
    exclusive_scan(space_, "collision/device_slots", counts_.view(), first_.view(), scratch_);
    parallel_for(space_, "collision/device_shape_numbers", 1,
                 CollectShapeNumbers{first_.view(), numbers_.view()});
    report_pairs<ShapeQuery::kVertex>(rules, 0, vertices);
    report_pairs<ShapeQuery::kFace>(rules, vertices, faces);
    report_pairs<ShapeQuery::kEdge>(rules, vertices + faces, edges);
}

template <ShapeQuery Query, typename Solid>
void DeviceContactDetector::count_pairs(const ShapeRules<Solid>& rules, int begin, int queries)
{
    parallel_for(space_, "collision/device_count_shape", queries,
                 CountShapePairs<Query, Solid>{rules, counts_.view().subview(begin, queries)});
}

template <ShapeQuery Query, typename Solid>
void DeviceContactDetector::report_pairs(const ShapeRules<Solid>& rules, int begin, int queries)
{
    const View<const int> counts = counts_.view();
    const View<const long> first = first_.view();
    parallel_for(space_, "collision/device_report_shape", queries,
                 ReportShapePairs<Query, Solid>{rules, counts.subview(begin, queries),
                                                first.subview(begin, queries),
                                                pairs_.view().subview(count_, pairs_.size() - count_)});
}

} // namespace toile::collision
