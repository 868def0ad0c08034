#pragma once

/// Random pairs of primitives in degenerate configurations, and their distance in quadruple precision.

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "core/compute/types.h"

namespace toile::test {

/// 33 digits: the errors of double precision in any degenerate case are far above its rounding.
using Quad = __float128;
using QuadVec = std::array<Quad, 3>;

inline QuadVec quad(const Vec3& v) { return {v[0], v[1], v[2]}; }
inline QuadVec combine(const QuadVec& a, Quad s, const QuadVec& b)
{
    return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}
inline QuadVec minus(const QuadVec& a, const QuadVec& b) { return combine(a, -1, b); }
inline Quad dot(const QuadVec& a, const QuadVec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline QuadVec cross(const QuadVec& a, const QuadVec& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline Quad point_segment2(const QuadVec& p, const QuadVec& a, const QuadVec& b)
{
    const QuadVec ab = minus(b, a);
    const Quad length2 = dot(ab, ab);
    Quad s = length2 > 0 ? dot(minus(p, a), ab) / length2 : Quad(0);
    s = s < 0 ? Quad(0) : s > 1 ? Quad(1) : s;
    const QuadVec d = minus(p, combine(a, s, ab));
    return dot(d, d);
}

/// Squared distance of a pair: the min over all features, interior minima only if they exist.
inline Quad distance2(bool is_edge_edge, const std::array<QuadVec, 4>& x)
{
    const auto& [p, a, b, c] = x;
    if (!is_edge_edge) {
        Quad best = std::min({point_segment2(p, a, b), point_segment2(p, b, c), point_segment2(p, c, a)});
        const QuadVec n = cross(minus(b, a), minus(c, a));
        const Quad n2 = dot(n, n);
        if (n2 > 0 && dot(n, cross(minus(b, a), minus(p, a))) >= 0 &&
            dot(n, cross(minus(c, b), minus(p, b))) >= 0 && dot(n, cross(minus(a, c), minus(p, c))) >= 0) {
            const Quad height = dot(n, minus(p, a));
            best = std::min(best, height * height / n2);
        }
        return best;
    }
    Quad best = std::min(
        {point_segment2(p, b, c), point_segment2(a, b, c), point_segment2(b, p, a), point_segment2(c, p, a)});
    const QuadVec da = minus(a, p), db = minus(c, b), gap = minus(b, p);
    const QuadVec n = cross(da, db);
    const Quad n2 = dot(n, n);
    const Quad s = dot(cross(gap, db), n), t = dot(cross(gap, da), n);
    if (n2 > 0 && s >= 0 && s <= n2 && t >= 0 && t <= n2) {
        const Quad height = dot(n, gap);
        best = std::min(best, height * height / n2);
    }
    return best;
}

inline double distance_at(bool is_edge_edge, const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& move,
                          double t)
{
    std::array<QuadVec, 4> now;
    for (int k = 0; k < 4; ++k)
        now[k] = combine(quad(x[k]), t, quad(move[k]));
    return double(std::sqrt((long double)(distance2(is_edge_edge, now))));
}

inline double exact_distance(bool is_edge_edge, const std::array<Vec3, 4>& x)
{
    return distance_at(is_edge_edge, x, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}, 0.0);
}

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}
    double uniform(double low, double high)
    {
        return std::uniform_real_distribution<double>(low, high)(engine_);
    }
    /// Random number, uniform in the logarithm.
    double scale(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
    int below(int count) { return std::uniform_int_distribution<int>(0, count - 1)(engine_); }
    Vec3 point() { return Vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)); }

private:
    std::mt19937 engine_;
};

enum class Awkward { kNone, kParallel, kCollapsed, kCoincident, kCoplanar, kFast, kTiny, kCount };

/// Pair of size about 1 m (only ratios matter), up to 2 m from the origin.
struct PairCase {
    Awkward kind;
    bool is_edge_edge;
    std::array<Vec3, 4> x, move;
};

inline PairCase random_case(Random& random)
{
    PairCase c{Awkward(random.below(int(Awkward::kCount))), random.below(2) == 0, {}, {}};
    for (int k = 0; k < 4; ++k) {
        c.x[k] = random.point();
        c.move[k] = random.point();
    }
    const double tiny = random.scale(1e-9, 1.0);
    switch (c.kind) {
    case Awkward::kParallel: // edges; for a triangle, the vertex moves in its normal plane
        c.x[3] = c.x[2] + random.uniform(-2, 2) * (c.x[1] - c.x[0]) + random.below(2) * tiny * random.point();
        break;
    case Awkward::kCollapsed: // corners on one line, or a needle
        c.x[3] = c.x[1] + random.uniform(-1, 2) * (c.x[2] - c.x[1]) + random.below(2) * tiny * random.point();
        break;
    case Awkward::kCoincident: // some corners coincide
        c.x[2 + random.below(2)] = c.x[1];
        if (random.below(4) == 0)
            c.x[2] = c.x[3];
        break;
    case Awkward::kCoplanar:
        for (int k = 0; k < 4; ++k)
            c.x[k][1] = 0.25;
        break;
    case Awkward::kFast: // at least 100 m/s for a frame
        for (Vec3& move : c.move)
            move *= random.scale(1.0, 1e3);
        break;
    case Awkward::kTiny: // the first primitive close above the second
        c.x[0] = (c.is_edge_edge ? Vec3(0.4 * c.x[2] + 0.6 * c.x[3])
                                 : Vec3(0.3 * c.x[1] + 0.2 * c.x[2] + 0.5 * c.x[3])) +
                 tiny * random.point();
        break;
    default:
        break;
    }
    return c;
}

} // namespace toile::test
