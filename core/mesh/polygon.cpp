#include "core/mesh/polygon.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace toile {

namespace {

/// Height over longest side below which a triangle is flat [-].
constexpr double kFlat = 1e-6;

/// Ears at least this much as high, over their longest side, as the best are as good.
constexpr double kAsGood = 0.5;

/// Relative difference that is no reason to choose: the lowest corner then wins, however the polygon lies
/// [-].
constexpr double kTie = 1e-9;

/// Twice the area, positive for a left turn.
double turn(const Vec2& a, const Vec2& b, const Vec2& c)
{
    return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

/// Corners in the plane of the polygon, counter-clockwise. The normal is the mean one, by area.
std::vector<Vec2> in_plane(View<const Vec3> corners)
{
    const int n = corners.size();
    Vec3 normal = Vec3::Zero();
    for (int k = 1; k + 1 < n; ++k)
        normal += (corners[k] - corners[0]).cross(corners[k + 1] - corners[0]);
    const Vec3 u = normal.unitOrthogonal(), v = normal.normalized().cross(u);
    std::vector<Vec2> plane;
    plane.reserve(size_t(n));
    for (const Vec3& p : corners)
        plane.emplace_back((p - corners[0]).dot(u), (p - corners[0]).dot(v));
    return plane;
}

/// Remaining part of a polygon. Cutting a corner removes it.
class Ring {
public:
    explicit Ring(std::vector<Vec2> corners) : x_(std::move(corners)), ears_(x_.size())
    {
        for (int k = 0; k < int(x_.size()); ++k)
            ring_.push_back(k);
        for (int i = 0; i < int(ring_.size()); ++i)
            look_at(i);
    }

    std::vector<Triangle> cut_up()
    {
        std::vector<Triangle> triangles;
        while (ring_.size() > 3)
            triangles.push_back(cut(best()));
        triangles.push_back(Triangle(ring_[0], ring_[1], ring_[2]));
        return triangles;
    }

private:
    struct Ear {
        double height = 0.0;   ///< over the longest side [-]; 0: concave
        double diagonal = 0.0; ///< [m]
        int blocker = -1;      ///< a corner in it, which must be cut before
    };

    int at(int i) const
    {
        const int n = int(ring_.size());
        return ring_[size_t((i + n) % n)];
    }

    void look_at(int i)
    {
        const int a = at(i - 1), b = at(i), c = at(i + 1);
        const double longest =
            std::max({(x_[b] - x_[a]).norm(), (x_[c] - x_[b]).norm(), (x_[a] - x_[c]).norm()});
        Ear& ear = ears_[size_t(b)];
        ear = {std::max(0.0, turn(x_[a], x_[b], x_[c]) / (longest * longest)), (x_[c] - x_[a]).norm(), -1};
        if (!(ear.height > kFlat)) {
            ear.height = 0.0;
            return;
        }
        for (const int k : ring_)
            if (k != a && k != b && k != c && turn(x_[a], x_[b], x_[k]) >= 0.0 &&
                turn(x_[b], x_[c], x_[k]) >= 0.0 && turn(x_[c], x_[a], x_[k]) >= 0.0) {
                ear.blocker = k;
                return;
            }
    }

    /// Place in the ring of the ear to cut. Where there is none, sides cross or all is flat: any corner.
    int best() const
    {
        double highest = 0.0;
        for (const int k : ring_)
            if (ears_[size_t(k)].blocker < 0)
                highest = std::max(highest, ears_[size_t(k)].height);
        int best = 0;
        double shortest = 1e300;
        for (int i = 0; i < int(ring_.size()); ++i) {
            const Ear& ear = ears_[size_t(at(i))];
            if (ear.blocker < 0 && highest > 0.0 && ear.height >= (1.0 - kTie) * kAsGood * highest &&
                ear.diagonal < (1.0 - kTie) * shortest) {
                best = i;
                shortest = ear.diagonal;
            }
        }
        return best;
    }

    Triangle cut(int i)
    {
        const int corner = at(i);
        Triangle triangle(at(i - 1), corner, at(i + 1));
        ring_.erase(ring_.begin() + i);
        look_at(i - 1);
        look_at(i);
        for (int k = 0; k < int(ring_.size()); ++k)
            if (ears_[size_t(at(k))].blocker == corner)
                look_at(k);
        return triangle;
    }

    std::vector<Vec2> x_;   ///< [corners]
    std::vector<Ear> ears_; ///< [corners]
    std::vector<int> ring_; ///< corners that remain
};

} // namespace

std::vector<Triangle> triangulate_polygon(View<const Vec3> corners)
{
    if (corners.size() == 3)
        return {Triangle(0, 1, 2)};
    const std::vector<Vec2> x = in_plane(corners);
    const auto is_convex = [&](int k) { return turn(x[k], x[(k + 1) % 4], x[(k + 2) % 4]) >= 0.0; };
    const auto is_good = [&](int a, int b, int c) {
        const double longest = std::max({(x[b] - x[a]).norm(), (x[c] - x[b]).norm(), (x[a] - x[c]).norm()});
        return turn(x[a], x[b], x[c]) > kFlat * longest * longest;
    };
    if (corners.size() == 4 && is_good(0, 1, 2) && is_good(0, 2, 3) && is_convex(1) && is_convex(3))
        return {Triangle(0, 1, 2), Triangle(0, 2, 3)};
    return Ring(x).cut_up();
}

std::vector<Vec2> convex_hull(std::vector<Vec2> points)
{
    std::sort(points.begin(), points.end(),
              [](const Vec2& a, const Vec2& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
    std::vector<Vec2> hull;
    const auto append = [&](const Vec2& p, size_t first) {
        const auto turns_left = [&] {
            const Vec2 &a = hull[hull.size() - 2], &b = hull.back();
            return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x()) > 0.0;
        };
        while (hull.size() >= first + 2 && !turns_left())
            hull.pop_back();
        hull.push_back(p);
    };
    for (const Vec2& p : points)
        append(p, 0);
    const size_t lower = hull.empty() ? 0 : hull.size() - 1;
    for (auto p = points.rbegin(); p != points.rend(); ++p)
        append(*p, lower);
    if (hull.size() > 1)
        hull.pop_back();
    return hull;
}

} // namespace toile
