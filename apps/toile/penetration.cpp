#include "apps/toile/penetration.h"

#include <algorithm>
#include <cmath>

#include "collision/penetration.h"
#include "core/backend/parallel.h"

namespace toile {

namespace {

/// One point's depth per slot; the largest is taken afterwards in order.
template <typename Depth>
struct MeasureDepth {
    const Depth& depth_of;
    View<double> depths; // [points] out [m]

    void operator()(int i) const { depths[i] = depth_of(i); }
};

} // namespace

ScenePenetration::ScenePenetration(const Scene& scene) : bodies_(make_bodies(scene))
{
    for (const SceneBody& body : bodies_)
        surfaces_.push_back(
            body.shape() != nullptr
                ? nullptr
                : std::make_unique<SurfaceProximity>(body.surface().triangles, body.surface().positions));
}

void ScenePenetration::advance_to(double t)
{
    for (size_t b = 0; b < bodies_.size(); ++b) {
        bodies_[b].advance_to(t);
        if (surfaces_[b])
            surfaces_[b]->update(bodies_[b].surface().positions);
    }
}

double ScenePenetration::depth(const Vec3& point) const
{
    if (!point.allFinite())
        return 0.0;
    double deepest = 0.0;
    for (size_t b = 0; b < bodies_.size(); ++b) {
        double signed_distance = 0.0;
        if (const Shape* shape = bodies_[b].shape())
            signed_distance = closest(*shape, bodies_[b].pose(), point).signed_distance;
        else if (const auto at = surfaces_[b]->closest(point))
            signed_distance = at->signed_distance;
        deepest = std::fmax(deepest, -signed_distance);
    }
    return deepest;
}

double ScenePenetration::depth(const Vec3& a, const Vec3& b, const Vec3& c) const
{
    double deepest = depth((a + b + c) / 3.0);
    for (const SceneBody& body : bodies_)
        if (body.shape() && a.allFinite() && b.allFinite() && c.allFinite())
            deepest = std::fmax(deepest, penetration_of_triangle(*body.shape(), body.pose(), a, b, c));
    return deepest;
}

double ScenePenetration::deepest(View<const Vec3> x, const std::vector<Triangle>& triangles) const
{
    const int vertices = x.size();
    std::vector<double> depths(size_t(vertices) + triangles.size());
    const auto depth_of = [&](int i) {
        if (i < vertices)
            return depth(x[i]);
        const Triangle& t = triangles[size_t(i - vertices)];
        return depth(x[t[0]], x[t[1]], x[t[2]]);
    };
    parallel_for(kCpu, "check/penetration", int(depths.size()),
                 MeasureDepth<decltype(depth_of)>{depth_of, depths});
    return depths.empty() ? 0.0 : *std::max_element(depths.begin(), depths.end());
}

} // namespace toile
