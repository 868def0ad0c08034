#include "garment/pattern/mesh/panel_fill.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <tuple>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/hilbert_sort.h>

#include "core/base/assert.h"

namespace toile::garment {

namespace {

/// Growth of the size with the distance from a shorter side of the outline [-].
constexpr double kGrowth = 0.3;
/// Radius of an empty circle over the size above which its centre becomes a vertex [-]: edges then have the
/// size on average.
constexpr double kLargeCircle = 0.74;
/// Distance of a new vertex from the outline over the size [-]
constexpr double kFromOutline = 0.5;
/// Edges shorter and longer than this over the size lose or get a vertex [-].
constexpr double kShort = 0.62, kLong = 1.45;
constexpr int kRounds = 4, kSweeps = 8, kPolishes = 6;
/// Triangles with a smaller angle are polished. [rad]
constexpr double kSmallAngle = 0.61;

struct VertexData {
    int index = -1; ///< on the outline; later of all
    double size = 0.0;
    bool is_fixed = false;
};

struct FaceData {
    int stamp = 0;
    bool is_inside = false;
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<VertexData, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<FaceData, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Cdt =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::No_constraint_intersection_tag>;
using Point = Cdt::Point;
using Vertex = Cdt::Vertex_handle;
using Face = Cdt::Face_handle;

Point point(const Vec2& x) { return {x.x(), x.y()}; }
Vec2 position(Vertex v) { return {v->point().x(), v->point().y()}; }

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

using Corners = std::array<Vec2, 3>;

Corners corners(Face f) { return {position(f->vertex(0)), position(f->vertex(1)), position(f->vertex(2))}; }

Vec2 circumcentre(const Corners& x)
{
    const Vec2 a = x[1] - x[0], b = x[2] - x[0];
    const double d = 2.0 * cross(a, b);
    return x[0] + Vec2(b.y() * a.squaredNorm() - a.y() * b.squaredNorm(),
                       a.x() * b.squaredNorm() - b.x() * a.squaredNorm()) /
                      d;
}

/// Smallest angle of a triangle; negative for a clockwise one. [rad]
double smallest_angle(const Corners& x)
{
    double smallest = 4.0;
    for (int k = 0; k < 3; ++k) {
        const Vec2 a = x[(k + 1) % 3] - x[k], b = x[(k + 2) % 3] - x[k];
        smallest = std::min(smallest, std::atan2(cross(a, b), a.dot(b)));
    }
    return smallest;
}

double distance_to_segment(const Vec2& x, const Vec2& a, const Vec2& b)
{
    const Vec2 ab = b - a;
    const double t = std::clamp((x - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
    return (x - a - t * ab).norm();
}

} // namespace

class PanelFill::Triangulation {
public:
    Triangulation(const std::vector<Vec2>& outline, double edge) : edge_(edge)
    {
        insert_outline(outline);
        mark_inside();
        insert_circumcentres();
        order_in_memory(outline);
        for (int round = 0; round < kRounds; ++round) {
            propagate_sizes();
            for (int sweep = 0; sweep < kSweeps; ++sweep)
                smooth();
            if (round + 1 < kRounds)
                adapt_count();
        }
        for (int i = 0; i < kPolishes; ++i) {
            polish();
            flip_to_delaunay();
        }
        renumber();
    }

    void split(const std::vector<std::array<int, 2>>& edges)
    {
        for (const auto& [a, b] : edges)
            split_edge(numbered_[a], numbered_[b]);
        for (int i = 0; i < kPolishes; ++i)
            polish();
        renumber();
    }

    std::vector<Vec2> vertices;
    std::vector<Triangle> triangles;

private:
    // Set-up.
    void insert_outline(const std::vector<Vec2>& outline);
    void mark_inside();
    void insert_circumcentres();
    void order_in_memory(const std::vector<Vec2>& outline);
    // Improvement.
    void propagate_sizes();
    void smooth();
    void adapt_count();
    void remove_crowded();
    void split_long();
    void polish();
    void flip_to_delaunay();
    // Result.
    void renumber();

    double size_at(Face f, const Vec2& x) const;
    Face find_face(Face from, const Vec2& x) const;
    bool is_near_outline(Face f, const Vec2& x, double distance) const;
    Vertex insert(const Vec2& x, Face f);
    void split_edge(Vertex a, Vertex b);
    bool may_move(Vertex v, const Vec2& x) const;
    double worst_angle_around(Vertex v, const Vec2& x) const;
    Vec2 star_centroid(Vertex v) const;

    template <typename Visit>
    void for_each_face(Vertex v, const Visit& visit) const
    {
        auto f = cdt_.incident_faces(v);
        const auto start = f;
        do
            visit(Face(f));
        while (++f != start);
    }

    double edge_;
    Cdt cdt_;
    std::vector<Vertex> outline_, inside_, numbered_;
    int stamps_ = 0;
};

void PanelFill::Triangulation::insert_outline(const std::vector<Vec2>& outline)
{
    const size_t n = outline.size();
    Face hint;
    for (size_t i = 0; i < n; ++i) {
        const Vertex v = cdt_.insert(point(outline[i]), hint);
        const double before = (outline[i] - outline[(i + n - 1) % n]).norm();
        const double after = (outline[(i + 1) % n] - outline[i]).norm();
        v->info() = {int(i), std::min(edge_, 0.5 * (before + after)), true};
        hint = v->face();
        outline_.push_back(v);
    }
    for (size_t i = 0; i < n; ++i)
        cdt_.insert_constraint(outline_[i], outline_[(i + 1) % n]);
}

/// Floods from the infinite vertex up to the outline; the rest is inside.
void PanelFill::Triangulation::mark_inside()
{
    for (const Face f : cdt_.all_face_handles())
        f->info().is_inside = true;
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

double PanelFill::Triangulation::size_at(Face f, const Vec2& x) const
{
    double size = edge_;
    for (int k = 0; k < 3; ++k)
        size = std::min(size, f->vertex(k)->info().size + kGrowth * (x - position(f->vertex(k))).norm());
    return size;
}

/// Walks from a face straight to the one that holds x; none where the outline is in between.
Face PanelFill::Triangulation::find_face(Face from, const Vec2& x) const
{
    constexpr int kMaxSteps = 10000;
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

bool PanelFill::Triangulation::is_near_outline(Face f, const Vec2& x, double distance) const
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

/// @param f  face that holds x
Vertex PanelFill::Triangulation::insert(const Vec2& x, Face f)
{
    const double size = size_at(f, x);
    const Vertex v = cdt_.insert(point(x), f);
    v->info() = {-1, size, false};
    for_each_face(v, [](Face face) { face->info().is_inside = true; });
    inside_.push_back(v);
    return v;
}

void PanelFill::Triangulation::insert_circumcentres()
{
    struct Circle {
        double ratio;
        int stamp;
        Face face;
        bool operator<(const Circle& other) const
        {
            return std::tie(ratio, other.stamp) < std::tie(other.ratio, stamp);
        }
    };
    std::priority_queue<Circle> queue;
    const auto push = [&](Face f) {
        f->info().stamp = ++stamps_;
        const Corners x = corners(f);
        const Vec2 centre = circumcentre(x);
        const double radius = (centre - x[0]).norm();
        const double ratio = radius / size_at(f, centre);
        if (ratio > kLargeCircle && std::isfinite(ratio))
            queue.push({ratio, stamps_, f});
    };
    for (const Face f : cdt_.finite_face_handles())
        if (f->info().is_inside)
            push(f);

    while (!queue.empty()) {
        const Circle circle = queue.top();
        queue.pop();
        if (circle.face->info().stamp != circle.stamp)
            continue;
        const Vec2 centre = circumcentre(corners(circle.face));
        const Face f = find_face(circle.face, centre);
        if (f == Face() || is_near_outline(f, centre, kFromOutline * size_at(f, centre)))
            continue;
        for_each_face(insert(centre, f), push);
    }
}

/// Builds the triangulation anew with neighbours near each other in memory: with a million vertices, sweeps
/// then take a fifth of the time.
void PanelFill::Triangulation::order_in_memory(const std::vector<Vec2>& outline)
{
    std::vector<Point> points;
    for (const Vertex v : inside_)
        points.push_back(v->point());
    CGAL::hilbert_sort(points.begin(), points.end());

    cdt_.clear();
    outline_.clear();
    inside_.clear();
    insert_outline(outline);
    Face hint;
    for (const Point& x : points) {
        const Vertex v = cdt_.insert(x, hint);
        v->info() = {-1, edge_, false};
        inside_.push_back(v);
        hint = v->face();
    }
    mark_inside();
}

/// Sizes from the outline's spacing along edges, shortest first.
void PanelFill::Triangulation::propagate_sizes()
{
    using Entry = std::tuple<double, int, Vertex>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    int count = 0;
    for (const Vertex v : inside_)
        v->info().size = edge_;
    for (const Vertex v : outline_)
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

/// Centroid of the triangles around a vertex, each weighted by its area over the size squared: spacing then
/// follows the size. (Higher powers crowd vertices where the size is small.)
Vec2 PanelFill::Triangulation::star_centroid(Vertex v) const
{
    Vec2 sum = Vec2::Zero();
    double weights = 0.0;
    for_each_face(v, [&](Face f) {
        const Corners x = corners(f);
        const double size =
            (f->vertex(0)->info().size + f->vertex(1)->info().size + f->vertex(2)->info().size) / 3.0;
        const double weight = cross(x[1] - x[0], x[2] - x[0]) / (size * size);
        sum += weight / 3.0 * (x[0] + x[1] + x[2]);
        weights += weight;
    });
    return sum / weights;
}

/// True if all triangles around a vertex stay counter-clockwise when it moves to x.
bool PanelFill::Triangulation::may_move(Vertex v, const Vec2& x) const
{
    bool may = true;
    for_each_face(v, [&](Face f) {
        const int k = f->index(v);
        may = may && CGAL::orientation(point(x), f->vertex(Cdt::ccw(k))->point(),
                                       f->vertex(Cdt::cw(k))->point()) == CGAL::LEFT_TURN;
    });
    return may;
}

void PanelFill::Triangulation::smooth()
{
    for (const Vertex v : inside_) {
        const Vec2 here = position(v), there = star_centroid(v);
        for (double t = 1.0; t > 0.1; t *= 0.5)
            if (const Vec2 x = here + t * (there - here); may_move(v, x)) {
                v->set_point(point(x));
                break;
            }
    }
    flip_to_delaunay();
}

/// Flips edges until the triangulation is constrained Delaunay [Lawson 1977]. CGAL's own loop over edges
/// keeps them in a sorted array, which takes quadratic time.
void PanelFill::Triangulation::flip_to_delaunay()
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

void PanelFill::Triangulation::adapt_count()
{
    remove_crowded();
    mark_inside();
    split_long();
}

/// Removes vertices with a short edge, none beside another of this round.
void PanelFill::Triangulation::remove_crowded()
{
    struct Crowded {
        double ratio;
        Vertex vertex;
    };
    std::vector<Crowded> crowded;
    std::vector<Vertex> rest;
    for (const Vertex v : inside_) {
        double shortest = edge_;
        for_each_face(v, [&](Face f) {
            shortest = std::min(shortest, (position(f->vertex(Cdt::ccw(f->index(v)))) - position(v)).norm());
        });
        if (shortest < kShort * v->info().size)
            crowded.push_back({shortest / v->info().size, v});
    }
    std::stable_sort(crowded.begin(), crowded.end(),
                     [](const Crowded& a, const Crowded& b) { return a.ratio < b.ratio; });

    for (const Vertex v : inside_)
        v->info().index = 0;
    for (const Crowded& item : crowded) {
        if (item.vertex->info().index != 0)
            continue;
        for_each_face(item.vertex, [](Face f) {
            for (int k = 0; k < 3; ++k)
                if (!f->vertex(k)->info().is_fixed)
                    f->vertex(k)->info().index = 1;
        });
        item.vertex->info().index = 2;
    }
    for (const Vertex v : inside_)
        if (v->info().index == 2)
            cdt_.remove(v);
        else
            rest.push_back(v);
    inside_ = rest;
}

void PanelFill::Triangulation::split_long()
{
    struct Long {
        double ratio;
        Vertex a, b;
    };
    std::vector<Long> edges;
    for (const auto& [f, k] : cdt_.finite_edges()) {
        if (!f->info().is_inside || f->is_constrained(k))
            continue;
        const Vertex a = f->vertex(Cdt::ccw(k)), b = f->vertex(Cdt::cw(k));
        const double ratio = (position(a) - position(b)).norm() * 2.0 / (a->info().size + b->info().size);
        if (ratio > kLong)
            edges.push_back({ratio, a, b});
    }
    std::stable_sort(edges.begin(), edges.end(),
                     [](const Long& a, const Long& b) { return a.ratio > b.ratio; });
    for (const Long& edge : edges)
        split_edge(edge.a, edge.b);
}

/// Splits an edge in the middle if it still exists.
void PanelFill::Triangulation::split_edge(Vertex a, Vertex b)
{
    Face f;
    int k = 0;
    if (cdt_.is_edge(a, b, f, k))
        insert(0.5 * (position(a) + position(b)), f->info().is_inside ? f : f->neighbor(k));
}

double PanelFill::Triangulation::worst_angle_around(Vertex v, const Vec2& x) const
{
    double worst = 4.0;
    for_each_face(v, [&](Face f) {
        Corners c = corners(f);
        c[f->index(v)] = x;
        worst = std::min(worst, smallest_angle(c));
    });
    return worst;
}

/// Moves vertices of triangles with a small angle by a pattern search that enlarges the smallest angle around
/// them.
void PanelFill::Triangulation::polish()
{
    constexpr int kDirections = 8;
    for (const Vertex v : inside_) {
        Vec2 best = position(v);
        double angle = worst_angle_around(v, best);
        if (angle > kSmallAngle)
            continue;
        for (double step = 0.2 * v->info().size; step > 0.01 * v->info().size; step *= 0.5)
            for (int i = 0; i < kDirections; ++i) {
                const Vec2 x = best + step * Vec2(std::cos(i * M_PI / 4), std::sin(i * M_PI / 4));
                if (const double there = worst_angle_around(v, x); there > angle && may_move(v, x)) {
                    angle = there;
                    best = x;
                }
            }
        v->set_point(point(best));
    }
}

void PanelFill::Triangulation::renumber()
{
    const auto row = [&](Vertex v) { return std::floor(v->point().y() / edge_); };
    std::stable_sort(inside_.begin(), inside_.end(), [&](Vertex a, Vertex b) {
        return std::tuple(row(a), a->point().x()) < std::tuple(row(b), b->point().x());
    });
    numbered_ = outline_;
    numbered_.insert(numbered_.end(), inside_.begin(), inside_.end());
    vertices.clear();
    for (size_t i = 0; i < numbered_.size(); ++i) {
        numbered_[i]->info().index = int(i);
        vertices.push_back(position(numbered_[i]));
    }
    triangles.clear();
    for (const Face f : cdt_.finite_face_handles()) {
        if (!f->info().is_inside)
            continue;
        Triangle t(f->vertex(0)->info().index, f->vertex(1)->info().index, f->vertex(2)->info().index);
        while (t[0] != t.minCoeff())
            t = Triangle(t[1], t[2], t[0]);
        triangles.push_back(t);
    }
    std::sort(triangles.begin(), triangles.end(), [](const Triangle& a, const Triangle& b) {
        return std::tie(a[0], a[1], a[2]) < std::tie(b[0], b[1], b[2]);
    });
}

PanelFill::PanelFill(const std::vector<Vec2>& outline, double edge)
    : triangulation_(std::make_unique<Triangulation>(outline, edge))
{
}
PanelFill::~PanelFill() = default;
PanelFill::PanelFill(PanelFill&&) noexcept = default;
PanelFill& PanelFill::operator=(PanelFill&&) noexcept = default;

void PanelFill::split(const std::vector<std::array<int, 2>>& edges) { triangulation_->split(edges); }
const std::vector<Vec2>& PanelFill::vertices() const { return triangulation_->vertices; }
const std::vector<Triangle>& PanelFill::triangles() const { return triangulation_->triangles; }

} // namespace toile::garment
