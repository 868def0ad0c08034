#include "avatars/landmarks/cross_section.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include <Eigen/Geometry>

#include "core/mesh/polygon.h"

namespace toile::avatars {

namespace {

/// Way over a triangle to the cut of another of its edges.
struct Link {
    int cut, triangle;
};

/// An edge of the surface that the plane cuts, and the cuts of its triangles' other edges.
struct Cut {
    Vec3 point = Vec3::Zero();
    std::vector<Link> next; ///< [1 or 2, more where triangles share the edge]
    bool visited = false;
};

struct Curve {
    std::vector<Vec3> points;
    std::vector<int> triangles; ///< as of SectionLoop
};

/// The cuts of a plane, linked by the triangles between them.
class Cuts {
public:
    Cuts(const TriangleMesh& mesh, const SectionPlane& plane)
    {
        std::vector<double> height(mesh.positions.size());
        for (size_t v = 0; v < height.size(); ++v)
            height[v] = plane.normal.dot(mesh.positions[v] - plane.point);
        for (int t = 0; t < mesh.triangle_count(); ++t)
            add(mesh, height, t);
    }

    std::vector<Curve> curves()
    {
        std::vector<Curve> curves;
        // Curves that end at borders first: from an end, so that they are whole.
        for (const size_t links : {1u, 2u})
            for (size_t c = 0; c < cuts_.size(); ++c)
                if (!cuts_[c].visited && (links == 2 || cuts_[c].next.size() == 1))
                    curves.push_back(walk(int(c)));
        return curves;
    }

private:
    void add(const TriangleMesh& mesh, const std::vector<double>& height, int triangle)
    {
        const Triangle& t = mesh.triangles[size_t(triangle)];
        int ends[2], found = 0;
        for (int k = 0; k < 3; ++k) {
            const int a = t[k], b = t[(k + 1) % 3];
            if ((height[size_t(a)] < 0.0) != (height[size_t(b)] < 0.0))
                ends[found++] = cut_of(mesh, height, std::min(a, b), std::max(a, b));
        }
        if (found != 2)
            return;
        cuts_[size_t(ends[0])].next.push_back({ends[1], triangle});
        cuts_[size_t(ends[1])].next.push_back({ends[0], triangle});
    }

    int cut_of(const TriangleMesh& mesh, const std::vector<double>& height, int a, int b)
    {
        const auto [at, is_new] =
            index_.try_emplace(std::uint64_t(a) << 32 | std::uint64_t(b), int(cuts_.size()));
        if (is_new) {
            const double t = height[size_t(a)] / (height[size_t(a)] - height[size_t(b)]);
            const Vec3 &xa = mesh.positions[size_t(a)], &xb = mesh.positions[size_t(b)];
            cuts_.push_back({xa + t * (xb - xa), {}, false});
        }
        return at->second;
    }

    Curve walk(int from)
    {
        Curve curve;
        for (int at = from; at >= 0;) {
            Cut& cut = cuts_[size_t(at)];
            cut.visited = true;
            curve.points.push_back(cut.point);
            auto next = std::find_if(cut.next.begin(), cut.next.end(),
                                     [&](const Link& link) { return !cuts_[size_t(link.cut)].visited; });
            const bool goes_on = next != cut.next.end();
            if (!goes_on)
                next = std::find_if(cut.next.begin(), cut.next.end(),
                                    [&](const Link& link) { return link.cut == from; });
            curve.triangles.push_back(next == cut.next.end() ? -1 : next->triangle);
            at = goes_on ? next->cut : -1;
        }
        return curve;
    }

    std::vector<Cut> cuts_;
    std::unordered_map<std::uint64_t, int> index_; ///< of an edge's cut
};

} // namespace

SectionPlane SectionPlane::through(const Vec3& point, const Vec3& normal)
{
    SectionPlane plane;
    plane.point = point;
    plane.normal = normal.normalized();
    plane.u = plane.normal.unitOrthogonal();
    plane.v = plane.normal.cross(plane.u);
    return plane;
}

SectionLoop loop_through(std::vector<Vec3> points, const SectionPlane& plane)
{
    SectionLoop loop;
    Vec2 moment = Vec2::Zero();
    double doubled = 0.0;
    for (size_t i = 0; i < points.size(); ++i) {
        const Vec2 a = plane.project(points[i]), b = plane.project(points[(i + 1) % points.size()]);
        const double cross = a.x() * b.y() - a.y() * b.x();
        doubled += cross;
        moment += cross * (a + b);
        loop.box.extend(points[i]);
    }
    loop.area = 0.5 * std::abs(doubled);
    loop.center = doubled != 0.0 ? plane.lift(moment / (3.0 * doubled)) : loop.box.center();
    loop.points = std::move(points);
    return loop;
}

std::vector<SectionLoop> cut(const TriangleMesh& mesh, const SectionPlane& plane)
{
    std::vector<SectionLoop> loops;
    for (Curve& curve : Cuts(mesh, plane).curves()) {
        if (curve.points.size() < 3)
            continue;
        loops.push_back(loop_through(std::move(curve.points), plane));
        loops.back().triangles = std::move(curve.triangles);
    }
    std::stable_sort(loops.begin(), loops.end(),
                     [](const SectionLoop& a, const SectionLoop& b) { return a.area > b.area; });
    return loops;
}

std::vector<Vec3> convex_hull(View<const Vec3> points, const SectionPlane& plane)
{
    std::vector<Vec2> flat;
    for (const Vec3& x : points)
        flat.push_back(plane.project(x));
    std::vector<Vec3> hull;
    for (const Vec2& x : toile::convex_hull(std::move(flat)))
        hull.push_back(plane.lift(x));
    return hull;
}

double open_length(View<const Vec3> points)
{
    double length = 0.0;
    for (int i = 1; i < points.size(); ++i)
        length += (points[i] - points[i - 1]).norm();
    return length;
}

double closed_length(View<const Vec3> points)
{
    return points.empty() ? 0.0 : open_length(points) + (points[points.size() - 1] - points[0]).norm();
}

} // namespace toile::avatars
