#include "collision/ccd/short_edges.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/compute/parallel.h"

namespace toile::collision {

namespace {

/// Largest length of an edge relative to that at the start [-].
constexpr double kMaxStretch = 1.02;

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

ShortEdges::ShortEdges(std::vector<Edge> edges, int vertex_count) : edges_(std::move(edges))
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

void ShortEdges::begin(View<const Vec3> base, double resolution)
{
    base_ = base;
    resolution_ = resolution;
}

void ShortEdges::find_overstretched(View<const int> vertices, View<const Vec3> motion,
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

bool ShortEdges::is_overstretched(int edge, View<const Vec3> motion) const
{
    const auto [a, b] = edges_[edge];
    const Vec3 before = base_[b] - base_[a];
    const double length2 = before.squaredNorm();
    return length2 < resolution_ * resolution_ &&
           (before + motion[b] - motion[a]).squaredNorm() > kMaxStretch * kMaxStretch * length2;
}

double ShortEdges::fraction(int edge, View<const Vec3> motion) const
{
    const auto [a, b] = edges_[edge];
    const Vec3 before = base_[b] - base_[a];
    return fraction_within(before, motion[b] - motion[a], kMaxStretch * kMaxStretch * before.squaredNorm());
}

} // namespace toile::collision
