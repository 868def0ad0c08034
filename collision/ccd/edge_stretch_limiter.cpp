#include "collision/ccd/edge_stretch_limiter.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/compute/parallel.h"

namespace toile::collision {

namespace {

/// Slack of a sliver, relative to its length [-].
constexpr double kStretch = 0.02;

/// Largest fraction [-], up to 1, for which |start + fraction displacement|^2 <= longest2, if start fulfils
/// that.
double fraction_within(const Vec3& start, const Vec3& displacement, double longest2)
{
    const double half = start.dot(displacement), square = displacement.squaredNorm();
    if (square == 0.0)
        return 1.0;
    const double remaining2 = longest2 - start.squaredNorm();
    return std::clamp((std::sqrt(half * half + square * std::max(remaining2, 0.0)) - half) / square, 0.0,
                      1.0);
}

} // namespace

EdgeStretchLimiter::EdgeStretchLimiter(std::vector<Edge> edges, int vertex_count) : edges_(std::move(edges))
{
    std::vector<int>& first = of_vertex_.first;
    first.assign(vertex_count + 1, 0);
    for (const Edge& edge : edges_)
        for (const int v : edge)
            ++first[v + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    of_vertex_.items.resize(first.back());
    std::vector<int> next(first.begin(), first.end() - 1);
    for (int e = 0; e < int(edges_.size()); ++e)
        for (const int v : edges_[e])
            of_vertex_.items[next[v]++] = e;
}

void EdgeStretchLimiter::begin(View<const Vec3> base, View<const Vec3> displacements, double slack)
{
    base_ = base;
    displacements_ = displacements;
    slack_ = slack;
}

void EdgeStretchLimiter::find_overstretched(View<const int> vertices, View<const Vec3> motion,
                                            std::vector<int>& overstretched) const
{
    overstretched.clear();
    parallel_append(
        kCpu, "collision/overstretched_edges", vertices.size(),
        [&](int begin, int end, std::vector<int>& found) {
            for (int i = begin; i < end; ++i)
                for (const int e : of_vertex_.of(vertices[i]))
                    if (is_overstretched(e, motion))
                        found.push_back(e);
        },
        overstretched);
    std::sort(overstretched.begin(), overstretched.end());
    overstretched.erase(std::unique(overstretched.begin(), overstretched.end()), overstretched.end());
}

bool EdgeStretchLimiter::is_sliver(int edge) const
{
    const auto [a, b] = edges_[edge];
    return (base_[b] - base_[a]).squaredNorm() < slack_ * slack_;
}

/// Square of the allowed length [m^2].
double EdgeStretchLimiter::longest2(int edge) const
{
    const auto [a, b] = edges_[edge];
    const Vec3 before = base_[b] - base_[a];
    const double length = before.norm();
    const double longest =
        is_sliver(edge) ? (1.0 + kStretch) * length
                        : std::max(length, (before + displacements_[b] - displacements_[a]).norm()) + slack_;
    return longest * longest;
}

bool EdgeStretchLimiter::is_overstretched(int edge, View<const Vec3> motion) const
{
    const auto [a, b] = edges_[edge];
    return (base_[b] + motion[b] - base_[a] - motion[a]).squaredNorm() > longest2(edge);
}

double EdgeStretchLimiter::fraction(int edge, View<const Vec3> motion) const
{
    const auto [a, b] = edges_[edge];
    return fraction_within(base_[b] - base_[a], motion[b] - motion[a], longest2(edge));
}

double EdgeStretchLimiter::trailing_fraction(int edge, int last, const Vec3& common,
                                             double min_fraction) const
{
    const auto [a, b] = edges_[edge];
    const int lead = last == a ? b : a;
    const Vec3 beyond = displacements_[last] - common;
    // Edge if both ends keep `min_fraction`, and the fraction that `last` may add to that.
    const Vec3 together =
        base_[last] - base_[lead] + min_fraction * (displacements_[last] - displacements_[lead]);
    return std::min(1.0, min_fraction + fraction_within(together, beyond, longest2(edge)));
}

} // namespace toile::collision
