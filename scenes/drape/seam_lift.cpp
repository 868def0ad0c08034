#include "scenes/drape/seam_lift.h"

#include <algorithm>

#include "collision/bvh/ray_scene.h"

namespace toile::scenes {

namespace {

constexpr double kStep = 0.005; ///< [m] between lifts that are tried

} // namespace

double shoulder_lift(const std::vector<std::vector<std::array<int, 2>>>& stitches, View<const Vec3> x,
                     const TriangleMesh& body)
{
    collision::RayScene scene;
    scene.add(body.positions, body.triangles);
    scene.commit();
    double lift = 0.0;
    const auto passes_through = [&](const std::array<int, 2>& thread, double height) {
        return scene.occluded(x[thread[0]] + height * Vec3::UnitY(), x[thread[1]] - x[thread[0]], 1.0);
    };
    for (const auto& seam : stitches) {
        const auto all_pass = [&](double height) {
            return std::all_of(seam.begin(), seam.end(),
                               [&](const auto& thread) { return passes_through(thread, height); });
        };
        const auto none_passes = [&](double height) {
            return std::none_of(seam.begin(), seam.end(),
                                [&](const auto& thread) { return passes_through(thread, height); });
        };
        if (seam.empty() || !all_pass(0.0))
            continue;
        double height = kStep;
        while (height <= kMaxLift && !none_passes(height))
            height += kStep;
        if (height <= kMaxLift)
            lift = std::max(lift, height);
    }
    return lift;
}

} // namespace toile::scenes
