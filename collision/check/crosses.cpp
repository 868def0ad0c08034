#include "collision/check/crosses.h"

#include <algorithm>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Intersections_3/Segment_3_Segment_3.h>
#include <CGAL/Intersections_3/Segment_3_Triangle_3.h>
#include <CGAL/Intersections_3/Triangle_3_Triangle_3.h>
#include <Eigen/Geometry>

namespace toile::collision {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Segment = Kernel::Segment_3;
using TriangleSet = Kernel::Triangle_3;

Point point(const Vec3& x) { return Point(x.x(), x.y(), x.z()); }

/// Set covered by three corners: the triangle, the two ends of a segment, or one point.
std::vector<Point> covered(const std::array<Vec3, 3>& corners)
{
    const Point a = point(corners[0]), b = point(corners[1]), c = point(corners[2]);
    if (!CGAL::collinear(a, b, c))
        return {a, b, c};
    // The ends are the minimum and the maximum in lexicographic order, which runs along the line.
    const Point& least = std::min({a, b, c});
    const Point& greatest = std::max({a, b, c});
    return least == greatest ? std::vector<Point>{a} : std::vector<Point>{least, greatest};
}

bool contains(const std::vector<Point>& set, const Point& p)
{
    if (set.empty())
        return false;
    if (set.size() == 1)
        return set[0] == p;
    return set.size() == 2 ? Segment(set[0], set[1]).has_on(p)
                           : TriangleSet(set[0], set[1], set[2]).has_on(p);
}

/// True if the segment meets the set, which is not a point.
bool meets(const Segment& segment, const std::vector<Point>& set)
{
    return set.size() == 2 ? CGAL::do_intersect(segment, Segment(set[0], set[1]))
                           : CGAL::do_intersect(segment, TriangleSet(set[0], set[1], set[2]));
}

/// crosses() if at least one triangle has no area. The common set is convex and at most a segment. It extends
/// beyond the shared corners in two cases: a corner of one lies in the other off the shared set, or the
/// segment meets an edge of the other triangle away from the shared corner.
bool crosses_flat(const TrianglePair& pair)
{
    std::vector<Point> a = covered(pair.a), b = covered(pair.b);
    if (a.size() > b.size())
        std::swap(a, b);
    std::vector<Point> shared;
    for (int k = 0; k < pair.shared; ++k)
        if (const Point corner = point(pair.a[k]); shared.empty() || shared[0] != corner)
            shared.push_back(corner);

    for (const Point& p : a)
        if (contains(b, p) && !contains(shared, p))
            return true;
    for (const Point& p : b)
        if (contains(a, p) && !contains(shared, p))
            return true;
    if (a.size() < 2)
        return false;
    const Segment segment(a[0], a[1]);
    if (shared.empty())
        return meets(segment, b);
    if (shared.size() == 2 || b.size() == 2)
        return false; // on one line the ends decide; else they cross in the shared corner only
    for (int k = 0; k < 3; ++k)
        if (b[k] == shared[0])
            return CGAL::do_intersect(segment, Segment(b[(k + 1) % 3], b[(k + 2) % 3]));
    return false;
}

} // namespace

bool has_no_area(const Vec3& a, const Vec3& b, const Vec3& c)
{
    // The rounding of the cross product is about 1e-15 of the edges' product; far above it the result is
    // certain.
    constexpr double kCertain2 = 1e-24;
    const Vec3 ab = b - a, ac = c - a;
    const double scale2 = ab.squaredNorm() * ac.squaredNorm();
    if (scale2 > 1e-200 && ab.cross(ac).squaredNorm() > kCertain2 * scale2)
        return false;
    const StandardArithmetic standard;
    return CGAL::collinear(point(a), point(b), point(c));
}

bool crosses(const TrianglePair& pair)
{
    if (pair.shared == 3)
        return false;
    if (pair.is_flat)
        return crosses_flat(pair);
    const Point a0 = point(pair.a[0]), a1 = point(pair.a[1]), a2 = point(pair.a[2]);
    const Point b0 = point(pair.b[0]), b1 = point(pair.b[1]), b2 = point(pair.b[2]);
    if (pair.shared == 2)
        return CGAL::coplanar(a0, a1, a2, b2) && CGAL::coplanar_orientation(a0, a1, a2, b2) == CGAL::POSITIVE;
    const TriangleSet a(a0, a1, a2), b(b0, b1, b2);
    if (pair.shared == 1)
        return CGAL::do_intersect(Segment(a1, a2), b) || CGAL::do_intersect(Segment(b1, b2), a);
    return CGAL::do_intersect(a, b);
}

} // namespace toile::collision
