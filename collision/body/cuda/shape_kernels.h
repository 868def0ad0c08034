#pragma once

/// Kernels of ContactDetector's search of one solid. Every cloth vertex, face and edge is a query. One pass
/// counts its pairs, prefix sums give their indices, and a second pass writes them.

#include "collision/body/cuda/detect_report.h"
#include "collision/geometry/shape_rules.h"

namespace toile::collision {

/// Distance of a cloth vertex from the skeleton.
struct MeasureSkeleton {
    View<const Vec3> x; ///< [vertices] [m]
    PlainSkeleton skeleton;
    View<double> distance; ///< [vertices] out [m]

    TOILE_HD void operator()(int v) const { distance[v] = skeleton.distance(x[v]); }
};

/// Kind of cloth primitive that searches for pairs.
enum class ShapeQuery { kVertex, kFace, kEdge };

template <ShapeQuery Query, typename Solid, typename Add>
TOILE_HD void visit_query(const ShapeRules<Solid>& rules, int i, const Add& add)
{
    if constexpr (Query == ShapeQuery::kVertex)
        rules.visit_vertex(i, add);
    else if constexpr (Query == ShapeQuery::kFace)
        rules.visit_face(i, add);
    else
        rules.visit_edge(i, add);
}

template <ShapeQuery Query, typename Solid>
struct CountShapePairs {
    ShapeRules<Solid> rules;
    View<int> counts; ///< [queries] out

    TOILE_HD void operator()(int i) const
    {
        int count = 0;
        visit_query<Query>(rules, i, [&](const ContactPair&) { ++count; });
        counts[i] = count;
    }
};

template <ShapeQuery Query, typename Solid>
struct ReportShapePairs {
    ShapeRules<Solid> rules;
    View<const int> counts;  ///< [queries]
    View<const long> first;  ///< [queries] prefix sums of counts
    View<ContactPair> pairs; ///< out, up to its capacity

    TOILE_HD void operator()(int i) const
    {
        if (counts[i] == 0)
            return;
        long next = first[i];
        visit_query<Query>(rules, i, [&](const ContactPair& pair) {
            if (next < pairs.size())
                pairs[int(next)] = pair;
            ++next;
        });
    }
};

struct CollectShapeNumbers {
    View<const long> first;      ///< prefix sums of all counts
    View<DetectNumbers> numbers; ///< [1] out

    TOILE_HD void operator()(int /*i*/) const { numbers[0] = {first[first.size() - 1], 0, 0, 0}; }
};

} // namespace toile::collision
