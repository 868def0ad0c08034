#include "collision/cloth/tethers.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/backend/parallel.h"

namespace toile {

namespace {

/// Slack of a sliver, of its length [-].
constexpr double kStretch = 0.02;

/// The largest share [-], up to 1, for which start + share way is no longer than `longest`, where start is
/// not.
double share_within(const Vec3& start, const Vec3& way, double longest2)
{
    const double half = start.dot(way), square = way.squaredNorm();
    if (square == 0.0)
        return 1.0;
    const double room = longest2 - start.squaredNorm();
    return std::clamp((std::sqrt(half * half + square * std::max(room, 0.0)) - half) / square, 0.0, 1.0);
}

} // namespace

Tethers::Tethers(std::vector<Edge> edges, int vertex_count) : edges_(std::move(edges))
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

void Tethers::begin(View<const Vec3> base, View<const Vec3> ways, double slack)
{
    base_ = base;
    ways_ = ways;
    slack_ = slack;
}

void Tethers::find_torn(View<const int> vertices, View<const Vec3> motion, std::vector<int>& torn) const
{
    torn.clear();
    parallel_append(
        kCpu, "collision/torn_edges", vertices.size(),
        [&](int begin, int end, std::vector<int>& found) {
            for (int i = begin; i < end; ++i)
                for (const int e : of_vertex_.of(vertices[i]))
                    if (is_torn(e, motion))
                        found.push_back(e);
        },
        torn);
    std::sort(torn.begin(), torn.end());
    torn.erase(std::unique(torn.begin(), torn.end()), torn.end());
}

bool Tethers::is_sliver(int edge) const
{
    const auto [a, b] = edges_[edge];
    return (base_[b] - base_[a]).squaredNorm() < slack_ * slack_;
}

/// Square of the length allowed [m^2].
double Tethers::longest2(int edge) const
{
    const auto [a, b] = edges_[edge];
    const Vec3 before = base_[b] - base_[a];
    const double length = before.norm();
    const double longest = is_sliver(edge) ? (1.0 + kStretch) * length
                                           : std::max(length, (before + ways_[b] - ways_[a]).norm()) + slack_;
    return longest * longest;
}

bool Tethers::is_torn(int edge, View<const Vec3> motion) const
{
    const auto [a, b] = edges_[edge];
    return (base_[b] + motion[b] - base_[a] - motion[a]).squaredNorm() > longest2(edge);
}

double Tethers::share(int edge, View<const Vec3> motion) const
{
    const auto [a, b] = edges_[edge];
    return share_within(base_[b] - base_[a], motion[b] - motion[a], longest2(edge));
}

double Tethers::share_behind(int edge, int last, const Vec3& common, double least) const
{
    const auto [a, b] = edges_[edge];
    const int lead = last == a ? b : a;
    const Vec3 beyond = ways_[last] - common;
    // Where both keep `least`, and what the last may add to that.
    const Vec3 together = base_[last] - base_[lead] + least * (ways_[last] - ways_[lead]);
    return std::min(1.0, least + share_within(together, beyond, longest2(edge)));
}

} // namespace toile
