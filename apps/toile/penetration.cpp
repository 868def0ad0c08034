#include "apps/toile/penetration.h"

#include <algorithm>

#include "core/backend/parallel.h"

namespace toile {

ScenePenetration::ScenePenetration(const Scene& scene, const std::vector<Triangle>& triangles,
                                   int vertex_count)
    : triangles_(triangles), samples_(triangles, vertex_count), bodies_(make_bodies(scene))
{
    for (const SceneBody& body : bodies_)
        meters_.push_back(body.shape() != nullptr ? nullptr
                                                  : std::make_unique<PenetrationMeter>(
                                                        body.surface().triangles, body.surface().positions));
}

void ScenePenetration::advance_to(double t)
{
    for (size_t b = 0; b < bodies_.size(); ++b)
        if (bodies_[b].advance_to(t) && meters_[b])
            meters_[b]->move(bodies_[b].surface().positions);
}

Penetration ScenePenetration::measure(View<const Vec3> x) const
{
    const std::vector<Vec3> samples = samples_.at(x);
    Penetration worst;
    for (size_t b = 0; b < bodies_.size(); ++b) {
        Penetration found;
        if (meters_[b])
            found = meters_[b]->measure(samples);
        else
            found.max_depth = deepest_in(bodies_[b], x);
        found.excluded_count += worst.excluded_count;
        found.deepest_excluded = std::max(found.deepest_excluded, worst.deepest_excluded);
        if (found.max_depth < worst.max_depth) {
            found.max_depth = worst.max_depth;
            found.sample = worst.sample;
            found.point = worst.point;
        }
        worst = found;
    }
    return worst;
}

double ScenePenetration::deepest_in(const SceneBody& solid, View<const Vec3> x) const
{
    std::vector<double> depths(triangles_.size());
    parallel_for(kCpu, "check/penetration", int(triangles_.size()), [&](int t) {
        const Triangle& corner = triangles_[t];
        const Vec3 &a = x[corner[0]], &b = x[corner[1]], &c = x[corner[2]];
        if (a.allFinite() && b.allFinite() && c.allFinite())
            depths[t] = penetration_of_triangle(*solid.shape(), solid.pose(), a, b, c);
    });
    return depths.empty() ? 0.0 : *std::max_element(depths.begin(), depths.end());
}

} // namespace toile
