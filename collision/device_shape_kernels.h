#pragma once

/// ContactDetector's search of one solid: kernels. Every cloth vertex, face and edge is a query; what it
/// finds is counted, counts are summed, and found once more in its place.

#include "collision/device_detect_report.h"
#include "collision/shape_rules.h"

namespace toile {

/// Distance of a cloth vertex from the skeleton.
struct MeasureSkeleton {
    View<const Vec3> x; ///< [vertices] [m]
    PlainSkeleton skeleton;
    View<double> distance; ///< [vertices] out [m]

    TOILE_HD void operator()(int v) const { distance[v] = skeleton.distance(x[v]); }
};

/// Who looks for pairs.
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
    View<const long> first;  ///< [queries] sums of counts
    View<ContactPair> pairs; ///< out, as far as there is room

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
    View<const long> first;      ///< sums of all counts
    View<DetectNumbers> numbers; ///< [1] out

    TOILE_HD void operator()(int /*i*/) const { numbers[0] = {first[first.size() - 1], 0, 0, 0}; }
};

} // namespace toile
