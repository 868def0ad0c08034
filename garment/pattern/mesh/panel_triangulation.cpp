#include "garment/pattern/mesh/panel_triangulation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <tuple>

#include <CGAL/hilbert_sort.h>

namespace toile::garment {

namespace {

/// Growth of the size with the distance from a shorter edge of the frame [-].
constexpr double kGrowth = 0.3;

using Point = PanelTriangulation::Kernel::Point_2;

Point point(const Vec2& x) { return {x.x(), x.y()}; }

double distance_to_segment(const Vec2& x, const Vec2& a, const Vec2& b)
{
    const Vec2 ab = b - a;
    const double t = std::clamp((x - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
    return (x - a - t * ab).norm();
}

/// Mean length of the frame's edges at each of its points, at most the target; that where there are none.
/// [points] [m]
std::vector<double> spacing_of(const PanelFrame& frame, double edge)
{
    std::vector<double> sum(frame.points.size(), 0.0), count = sum;
    for (const auto& [a, b] : edges_of(frame))
        for (const int i : {a, b}) {
            sum[i] += (frame.points[a] - frame.points[b]).norm();
            count[i] += 1.0;
        }
    for (size_t i = 0; i < sum.size(); ++i)
        sum[i] = count[i] > 0.0 ? std::min(edge, sum[i] / count[i]) : edge;
    return sum;
}

} // namespace

PanelTriangulation::PanelTriangulation(const PanelFrame& frame, double edge) : frame_(frame), edge_(edge)
{
    insert_frame();
    mark_outside();
}

void PanelTriangulation::insert_frame()
{
    const std::vector<double> spacing = spacing_of(frame_, edge_);
    Face hint;
    for (size_t i = 0; i < frame_.points.size(); ++i) {
        const Vertex v = cdt_.insert(point(frame_.points[i]), hint);
        v->info() = {int(i), spacing[i], true};
        hint = v->face();
        fixed_.push_back(v);
    }
    for (const auto& [a, b] : edges_of(frame_))
        cdt_.insert_constraint(fixed_[a], fixed_[b]);
}

/// Floods from the infinite vertex up to the outline; the rest is inside.
void PanelTriangulation::mark_outside()
{
    std::vector<Face> outside{cdt_.infinite_face()};
    outside[0]->info().is_inside = false;
    while (!outside.empty()) {
        const Face f = outside.back();
        outside.pop_back();
        for (int k = 0; k < 3; ++k)
            if (const Face next = f->neighbor(k); !f->is_constrained(k) && next->info().is_inside) {
                next->info().is_inside = false;
                outside.push_back(next);
            }
    }
}

std::vector<PanelTriangulation::Face> PanelTriangulation::inside_faces() const
{
    std::vector<Face> faces;
    for (const Face f : cdt_.finite_face_handles())
        if (f->info().is_inside)
            faces.push_back(f);
    return faces;
}

/// CGAL's own loop over edges compares addresses of faces, so that its order differs from run to run.
std::vector<std::array<PanelTriangulation::Vertex, 2>> PanelTriangulation::free_edges() const
{
    const std::vector<Face> faces = inside_faces();
    for (size_t i = 0; i < faces.size(); ++i)
        faces[i]->info().stamp = int(i);
    std::vector<std::array<Vertex, 2>> edges;
    for (const Face f : faces)
        for (int k = 0; k < 3; ++k)
            if (!f->is_constrained(k) && f->info().stamp < f->neighbor(k)->info().stamp)
                edges.push_back({f->vertex(Cdt::ccw(k)), f->vertex(Cdt::cw(k))});
    return edges;
}

PanelTriangulation::Corners PanelTriangulation::corners(Face f)
{
    return {position(f->vertex(0)), position(f->vertex(1)), position(f->vertex(2))};
}

PanelTriangulation::Face PanelTriangulation::find_face(Face from, const Vec2& x) const
{
    constexpr int kMaxSteps = 10000; // rounding can't make the walk circle for ever
    for (int step = 0; step < kMaxSteps; ++step) {
        int exit = -1;
        for (int k = 0; k < 3 && exit < 0; ++k)
            if (CGAL::orientation(from->vertex(Cdt::ccw(k))->point(), from->vertex(Cdt::cw(k))->point(),
                                  point(x)) == CGAL::RIGHT_TURN)
                exit = k;
        if (exit < 0)
            return from;
        if (from->is_constrained(exit))
            return {};
        from = from->neighbor(exit);
    }
    return {};
}

double PanelTriangulation::size_at(Face f, const Vec2& x) const
{
    double size = edge_;
    for (int k = 0; k < 3; ++k)
        size = std::min(size, f->vertex(k)->info().size + kGrowth * (x - position(f->vertex(k))).norm());
    return size;
}

bool PanelTriangulation::is_near_frame(Face f, const Vec2& x, double distance) const
{
    const auto has_near_side = [&](Face face) {
        for (int k = 0; k < 3; ++k)
            if (face->is_constrained(k) && distance_to_segment(x, position(face->vertex(Cdt::ccw(k))),
                                                               position(face->vertex(Cdt::cw(k)))) < distance)
                return true;
        return false;
    };
    if (has_near_side(f))
        return true;
    for (int k = 0; k < 3; ++k)
        if (!f->is_constrained(k) && has_near_side(f->neighbor(k)))
            return true;
    return false;
}

bool PanelTriangulation::may_move(Vertex v, const Vec2& x) const
{
    bool may = true;
    for_each_face(v, [&](Face f) {
        const int k = f->index(v);
        may = may && CGAL::orientation(point(x), f->vertex(Cdt::ccw(k))->point(),
                                       f->vertex(Cdt::cw(k))->point()) == CGAL::LEFT_TURN;
    });
    return may;
}

PanelTriangulation::Vertex PanelTriangulation::insert(const Vec2& x, Face f)
{
    const double size = size_at(f, x);
    const Vertex v = cdt_.insert(point(x), f);
    v->info() = {-1, size, false};
    inside_.push_back(v);
    return v;
}

void PanelTriangulation::split_edge(Vertex a, Vertex b)
{
    Face f;
    int k = 0;
    if (cdt_.is_edge(a, b, f, k))
        insert(0.5 * (position(a) + position(b)), f->info().is_inside ? f : f->neighbor(k));
}

void PanelTriangulation::move(Vertex v, const Vec2& x) { v->set_point(point(x)); }

void PanelTriangulation::remove(const std::vector<Vertex>& vertices)
{
    constexpr int kLeaves = -2;
    for (const Vertex v : vertices)
        v->info().index = kLeaves;
    std::vector<Vertex> rest;
    for (const Vertex v : inside_)
        if (v->info().index == kLeaves)
            cdt_.remove(v);
        else
            rest.push_back(v);
    inside_ = std::move(rest);
}

/// CGAL's own loop over edges keeps them in a sorted array, which takes quadratic time.
void PanelTriangulation::flip_to_delaunay()
{
    for (bool has_flipped = true; has_flipped;) {
        has_flipped = false;
        for (Face f : cdt_.finite_face_handles())
            for (int k = 0; k < 3; ++k)
                if (f->info().is_inside && cdt_.is_flipable(f, k)) {
                    cdt_.flip(f, k);
                    has_flipped = true;
                }
    }
}

void PanelTriangulation::propagate_sizes()
{
    using Entry = std::tuple<double, int, Vertex>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    int count = 0;
    for (const Vertex v : inside_)
        v->info().size = edge_;
    for (const Vertex v : fixed_)
        queue.emplace(v->info().size, count++, v);
    while (!queue.empty()) {
        const auto [size, number, v] = queue.top();
        queue.pop();
        if (size > v->info().size)
            continue;
        for_each_face(v, [&, size = size, v = v](Face f) {
            if (!f->info().is_inside)
                return;
            const Vertex next = f->vertex(Cdt::ccw(f->index(v)));
            const double grown = size + kGrowth * (position(next) - position(v)).norm();
            if (!next->info().is_fixed && grown < next->info().size) {
                next->info().size = grown;
                queue.emplace(grown, count++, next);
            }
        });
    }
}

void PanelTriangulation::order_in_memory()
{
    std::vector<Point> points;
    for (const Vertex v : inside_)
        points.push_back(v->point());
    CGAL::hilbert_sort(points.begin(), points.end());

    cdt_.clear();
    fixed_.clear();
    inside_.clear();
    insert_frame();
    Face hint;
    for (const Point& x : points) {
        const Vertex v = cdt_.insert(x, hint);
        v->info() = {-1, edge_, false};
        inside_.push_back(v);
        hint = v->face();
    }
    mark_outside();
}

std::vector<PanelTriangulation::Vertex> PanelTriangulation::number_vertices()
{
    const auto row = [&](Vertex v) { return std::floor(v->point().y() / edge_); };
    std::stable_sort(inside_.begin(), inside_.end(), [&](Vertex a, Vertex b) {
        return std::tuple(row(a), a->point().x()) < std::tuple(row(b), b->point().x());
    });
    std::vector<Vertex> numbered = fixed_;
    numbered.insert(numbered.end(), inside_.begin(), inside_.end());
    for (size_t i = 0; i < numbered.size(); ++i)
        numbered[i]->info().index = int(i);
    return numbered;
}

} // namespace toile::garment
