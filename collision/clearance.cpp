#include "collision/clearance.h"

#include <algorithm>

#include "core/backend/parallel.h"

namespace toile {

namespace {

/// What rounding may take of a bound [m].
constexpr double kRounding = 1e-9;

/// From a displacement to the farthest one of a box of them [m].
double farthest(const Vec3& motion, const Bounds& others)
{
    return (motion - others.lower).cwiseAbs().cwiseMax((motion - others.upper).cwiseAbs()).norm();
}

} // namespace

void Clearance::follow(View<const Vec3> x, const MeshCollider& mesh)
{
    const bool stood = mesh.move_count() == move_count_;
    const bool is_known = stood || mesh.move_count() == move_count_ + 1;
    move_count_ = mesh.move_count();
    parallel_for(kCpu, "collision/clearance", x.size(), [&](int v) {
        const Vec3 motion = x[v] - x_[v];
        x_[v] = x[v];
        if (!is_known)
            bound_[v] = 0.0;
        else if (stood)
            bound_[v] -= motion.norm() + kRounding;
        else if (const Bounds& others = mesh.last_motion().around(x[v]); others.empty())
            bound_[v] = MotionBounds::kReach;
        else
            bound_[v] = std::min(bound_[v], MotionBounds::kReach) - farthest(motion, others) - kRounding;
        bound_[v] = std::max(bound_[v], 0.0);
    });
}

void Clearance::learn(int vertex, double distance, int triangle)
{
    nearest_[vertex] = triangle;
    bound_[vertex] = std::min(distance, MotionBounds::kReach);
}

} // namespace toile
