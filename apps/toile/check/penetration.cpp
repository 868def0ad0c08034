#include "apps/toile/check/penetration.h"

#include <algorithm>
#include <utility>

#include "core/base/long_work.h"
#include "core/compute/parallel.h"
#include "scenes/world/contact_setup.h"

namespace toile::app {

namespace {

/// Depth of the deepest triangle in a shape [m], and the triangle's centroid [m].
std::pair<double, Vec3> deepest_in(const scenes::SceneBody& solid, View<const Vec3> x,
                                   View<const Triangle> triangles)
{
    std::vector<double> depths(triangles.size());
    parallel_for(kCpu, "check/penetration", triangles.size(), [&](int t) {
        const Triangle& corner = triangles[t];
        const Vec3 &a = x[corner[0]], &b = x[corner[1]], &c = x[corner[2]];
        if (a.allFinite() && b.allFinite() && c.allFinite())
            depths[t] = penetration_of_triangle(*solid.shape(), solid.pose(), a, b, c);
    });
    if (depths.empty())
        return {0.0, Vec3::Zero()};
    const auto deepest = std::max_element(depths.begin(), depths.end());
    const Triangle& t = triangles[int(deepest - depths.begin())];
    return {*deepest, (x[t[0]] + x[t[1]] + x[t[2]]) / 3.0};
}

} // namespace

ScenePenetration::ScenePenetration(const scenes::Scene& scene)
{
    constexpr double kBodies = 0.5; // part of the work
    {
        const LongWork::Part part(0.0, kBodies);
        bodies_ = make_bodies(scene);
    }
    const LongWork::Part part(kBodies, 1.0);
    collision::PenetrationMeter::Settings settings;
    settings.room = scenes::room_for_cloth(scene);
    for (const scenes::SceneBody& body : bodies_) {
        LongWork::update(double(meters_.size()) / double(bodies_.size()));
        meters_.push_back(body.shape() != nullptr ? nullptr
                                                  : std::make_unique<collision::PenetrationMeter>(
                                                        body.contact_surface().triangles,
                                                        body.contact_surface().positions, settings));
    }
    LongWork::update(1.0);
}

std::vector<AvatarPassage> ScenePenetration::advance_to(double t,
                                                        const std::vector<collision::ClothFrames>& cloths)
{
    std::vector<AvatarPassage> all;
    for (size_t b = 0; b < bodies_.size(); ++b) {
        const Eigen::Isometry3d before = bodies_[b].pose();
        const bool has_moved = bodies_[b].advance_to(t);
        const std::vector<Vec3>& surface = bodies_[b].contact_surface().positions;
        for (size_t c = 0; c < cloths.size(); ++c)
            for (const collision::Passage& passage :
                 meters_[b] ? find_passages(cloths[c], *meters_[b], surface)
                            : find_passages(cloths[c], *bodies_[b].shape(), before, bodies_[b].pose()))
                all.push_back({int(c), int(b), passage});
        if (has_moved && meters_[b])
            meters_[b]->move(surface);
    }
    return all;
}

ScenePenetration::Depth
ScenePenetration::measure(View<const Vec3> x, View<const Triangle> triangles,
                          const collision::ClothSamples& samples,
                          std::vector<collision::PenetrationMeter::Sides>& sides) const
{
    sides.resize(bodies_.size());
    const std::vector<Vec3> points = samples.at(x);
    Depth depth;
    const auto add = [&](double deepest, const Vec3& point) {
        if (deepest <= depth.deepest)
            return;
        depth.deepest = deepest;
        depth.point = point;
    };
    for (size_t b = 0; b < bodies_.size(); ++b) {
        if (!meters_[b]) {
            const auto [deepest, point] = deepest_in(bodies_[b], x, triangles);
            add(deepest, point);
            continue;
        }
        const collision::Penetration found = meters_[b]->measure(points, &sides[b]);
        add(found.max_depth, found.point);
        depth.pinched = std::max(depth.pinched, found.deepest_excluded);
    }
    return depth;
}

} // namespace toile::app
