#include "tests/collision/check/exact_overlap.h"

#include <algorithm>
#include <array>

#include <boost/multiprecision/cpp_int.hpp>

namespace toile::test {

namespace {

using Number = boost::multiprecision::cpp_rational;
using Point = std::array<Number, 3>;
using Polygon = std::vector<Point>;

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Number dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Point cross(const Point& a, const Point& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

bool is_zero(const Point& a) { return a[0] == 0 && a[1] == 0 && a[2] == 0; }

Polygon exact(const std::vector<Vec3>& points)
{
    Polygon polygon;
    for (const Vec3& p : points)
        polygon.push_back({Number(p.x()), Number(p.y()), Number(p.z())});
    return polygon;
}

/// Part of a polygon where normal . (x - origin) >= 0 [Sutherland and Hodgman 1974].
Polygon clipped(const Polygon& polygon, const Point& normal, const Point& origin)
{
    Polygon kept;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const Point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const Number at_p = dot(normal, minus(p, origin)), at_q = dot(normal, minus(q, origin));
        if (at_p >= 0)
            kept.push_back(p);
        if ((at_p < 0 && at_q > 0) || (at_p > 0 && at_q < 0)) {
            const Number s = at_p / (at_p - at_q);
            Point between;
            for (int k = 0; k < 3; ++k)
                between[k] = p[k] + s * (q[k] - p[k]);
            kept.push_back(between);
        }
    }
    return kept;
}

Polygon on_plane(const Polygon& polygon, const Point& normal, const Point& origin)
{
    return clipped(clipped(polygon, normal, origin), minus(Point{}, normal), origin);
}

/// Part of a polygon on the segment p q, which may be a point.
Polygon on_segment(Polygon polygon, const Point& p, const Point& q)
{
    const Point along = minus(q, p);
    for (int k = 0; k < 3; ++k) {
        Point axis{};
        axis[k] = 1;
        polygon = on_plane(polygon, is_zero(along) ? axis : cross(along, axis), p);
    }
    polygon = clipped(polygon, along, p);
    return clipped(polygon, minus(Point{}, along), q);
}

Polygon within(Polygon polygon, const Polygon& hull)
{
    if (hull.size() < 3)
        return on_segment(polygon, hull.front(), hull.back());
    const Point normal = cross(minus(hull[1], hull[0]), minus(hull[2], hull[0]));
    if (is_zero(normal))
        return on_segment(polygon, *std::min_element(hull.begin(), hull.end()),
                          *std::max_element(hull.begin(), hull.end()));
    polygon = on_plane(polygon, normal, hull[0]);
    for (int k = 0; k < 3; ++k)
        polygon = clipped(polygon, cross(normal, minus(hull[(k + 1) % 3], hull[k])), hull[k]);
    return polygon;
}

} // namespace

bool overlap_beyond(const std::vector<Vec3>& a, const std::vector<Vec3>& b, const std::vector<Vec3>& shared)
{
    const Polygon common = within(exact(a), exact(b));
    const Polygon allowed = exact(shared);
    return std::any_of(common.begin(), common.end(),
                       [&](const Point& p) { return allowed.empty() || within({p}, allowed).empty(); });
}

} // namespace toile::test
