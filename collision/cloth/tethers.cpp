#include "collision/cloth/tethers.h"

#include <algorithm>
#include <cmath>

#include "core/backend/parallel.h"

namespace toile {

namespace {

/// Slack of a sliver, of its length [-].
constexpr double kStretch = 0.02;

} // namespace

void Tethers::begin(View<const Vec3> base, View<const Vec3> ways, double slack)
{
    base_ = base;
    slack_ = slack;
    longest2_.resize(edges_.size());
    parallel_for(kCpu, "collision/tethers", int(edges_.size()), [&](int e) {
        const auto [a, b] = edges_[e];
        const Vec3 before = base[b] - base[a];
        const double length = before.norm();
        const double longest = is_sliver(e) ? (1.0 + kStretch) * length
                                            : std::max(length, (before + ways[b] - ways[a]).norm()) + slack;
        longest2_[e] = longest * longest;
    });
}

bool Tethers::is_sliver(int edge) const
{
    const auto [a, b] = edges_[edge];
    return (base_[b] - base_[a]).squaredNorm() < slack_ * slack_;
}

bool Tethers::is_torn(int edge, View<const Vec3> motion) const
{
    const auto [a, b] = edges_[edge];
    return (base_[b] + motion[b] - base_[a] - motion[a]).squaredNorm() > longest2_[edge];
}

/// |before + share difference|^2 = longest^2, where `before` is shorter.
double Tethers::share(int edge, View<const Vec3> motion) const
{
    const auto [a, b] = edges_[edge];
    const Vec3 before = base_[b] - base_[a], difference = motion[b] - motion[a];
    const double half = before.dot(difference), square = difference.squaredNorm();
    const double room = longest2_[edge] - before.squaredNorm();
    return std::clamp((std::sqrt(half * half + square * room) - half) / square, 0.0, 1.0);
}

} // namespace toile
