#include "garment/pattern/mesh/panel_fill.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>
#include <tuple>

#include "garment/pattern/mesh/panel_triangulation.h"

namespace toile::garment {

namespace {

using Cdt = PanelTriangulation::Cdt;
using Vertex = PanelTriangulation::Vertex;
using Face = PanelTriangulation::Face;
using Corners = PanelTriangulation::Corners;

/// Radius of an empty circle over the size above which its centre becomes a vertex [-]: edges then have the
/// size on average.
constexpr double kLargeCircle = 0.74;
/// Distance of a new vertex from the frame over the size [-]
constexpr double kFromFrame = 0.5;
/// Edges shorter and longer than this over the size lose or get a vertex [-].
constexpr double kShort = 0.62, kLong = 1.45;
constexpr int kRounds = 4, kSweeps = 8, kPolishes = 6;
/// Triangles with a smaller angle are polished [rad].
constexpr double kSmallAngle = 0.61;
/// Vertices of triangles with a smaller angle go if that enlarges the smallest angle around [rad].
constexpr double kBadAngle = 0.44;

Vec2 position(Vertex v) { return PanelTriangulation::position(v); }

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

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

/// Empty circle around a face. The largest over the size comes first.
struct Circle {
    double ratio;
    int stamp;
    Face face;

    bool operator<(const Circle& other) const
    {
        return std::tie(ratio, other.stamp) < std::tie(other.ratio, stamp);
    }
};

void insert_circumcentres(PanelTriangulation& triangulation)
{
    std::priority_queue<Circle> queue;
    int stamps = 0;
    const auto push = [&](Face f) {
        f->info().stamp = ++stamps;
        const Corners x = PanelTriangulation::corners(f);
        const Vec2 centre = circumcentre(x);
        const double ratio = (centre - x[0]).norm() / triangulation.size_at(f, centre);
        if (ratio > kLargeCircle && std::isfinite(ratio))
            queue.push({ratio, stamps, f});
    };
    for (const Face f : triangulation.inside_faces())
        push(f);
    while (!queue.empty()) {
        const Circle circle = queue.top();
        queue.pop();
        if (circle.face->info().stamp != circle.stamp)
            continue;
        const Vec2 centre = circumcentre(PanelTriangulation::corners(circle.face));
        const Face f = triangulation.find_face(circle.face, centre);
        if (f != Face() &&
            !triangulation.is_near_frame(f, centre, kFromFrame * triangulation.size_at(f, centre)))
            triangulation.for_each_face(triangulation.insert(centre, f), push);
    }
}

/// Centroid of the triangles around a vertex, each weighted by its area over the size squared: spacing then
/// follows the size. (Higher powers crowd vertices where the size is small.)
Vec2 star_centroid(const PanelTriangulation& triangulation, Vertex v)
{
    Vec2 sum = Vec2::Zero();
    double weights = 0.0;
    triangulation.for_each_face(v, [&](Face f) {
        const Corners x = PanelTriangulation::corners(f);
        const double size =
            (f->vertex(0)->info().size + f->vertex(1)->info().size + f->vertex(2)->info().size) / 3.0;
        const double weight = cross(x[1] - x[0], x[2] - x[0]) / (size * size);
        sum += weight / 3.0 * (x[0] + x[1] + x[2]);
        weights += weight;
    });
    return sum / weights;
}

void smooth(PanelTriangulation& triangulation)
{
    for (const Vertex v : triangulation.inside()) {
        const Vec2 here = position(v), there = star_centroid(triangulation, v);
        for (double t = 1.0; t > 0.1; t *= 0.5)
            if (const Vec2 x = here + t * (there - here); triangulation.may_move(v, x)) {
                triangulation.move(v, x);
                break;
            }
    }
    triangulation.flip_to_delaunay();
}

/// Calls visit(neighbour) for the vertices around one inside.
template <typename Visit>
void for_each_neighbour(const PanelTriangulation& triangulation, Vertex v, const Visit& visit)
{
    triangulation.for_each_face(v, [&](Face f) { visit(f->vertex(Cdt::ccw(f->index(v)))); });
}

/// Removes vertices with a short edge, the shortest first and none beside another.
void remove_crowded(PanelTriangulation& triangulation)
{
    std::vector<std::pair<double, Vertex>> crowded;
    for (const Vertex v : triangulation.inside()) {
        double shortest = triangulation.edge();
        for_each_neighbour(triangulation, v, [&](Vertex next) {
            shortest = std::min(shortest, (position(next) - position(v)).norm());
        });
        if (shortest < kShort * v->info().size)
            crowded.emplace_back(shortest / v->info().size, v);
    }
    std::stable_sort(crowded.begin(), crowded.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });

    constexpr int kFree = 0, kTaken = 1;
    for (const Vertex v : triangulation.inside())
        v->info().index = kFree;
    std::vector<Vertex> removed;
    for (const auto& [ratio, v] : crowded) {
        if (v->info().index == kTaken)
            continue;
        for_each_neighbour(triangulation, v, [](Vertex next) { next->info().index = kTaken; });
        removed.push_back(v);
    }
    triangulation.remove(removed);
}

void split_long(PanelTriangulation& triangulation)
{
    struct Long {
        double ratio;
        std::array<Vertex, 2> ends;
    };
    std::vector<Long> edges;
    for (const auto& [a, b] : triangulation.free_edges())
        if (const double ratio = (position(a) - position(b)).norm() * 2.0 / (a->info().size + b->info().size);
            ratio > kLong)
            edges.push_back({ratio, {a, b}});
    std::stable_sort(edges.begin(), edges.end(),
                     [](const Long& a, const Long& b) { return a.ratio > b.ratio; });
    for (const auto& [ratio, ends] : edges)
        triangulation.split_edge(ends[0], ends[1]);
}

/// Smallest angle around a vertex if it were at x. [rad]
double worst_angle_around(const PanelTriangulation& triangulation, Vertex v, const Vec2& x)
{
    double worst = 4.0;
    triangulation.for_each_face(v, [&](Face f) {
        Corners c = PanelTriangulation::corners(f);
        c[f->index(v)] = x;
        worst = std::min(worst, smallest_angle(c));
    });
    return worst;
}

/// Moves vertices of triangles with a small angle by a pattern search that enlarges the smallest angle around
/// them.
void polish(PanelTriangulation& triangulation)
{
    constexpr int kDirections = 8;
    for (const Vertex v : triangulation.inside()) {
        Vec2 best = position(v);
        double angle = worst_angle_around(triangulation, v, best);
        if (angle > kSmallAngle)
            continue;
        for (double step = 0.2 * v->info().size; step > 0.01 * v->info().size; step *= 0.5)
            for (int i = 0; i < kDirections; ++i) {
                const double direction = 2.0 * std::numbers::pi * i / kDirections;
                const Vec2 x = best + step * Vec2(std::cos(direction), std::sin(direction));
                if (const double there = worst_angle_around(triangulation, v, x);
                    there > angle && triangulation.may_move(v, x)) {
                    angle = there;
                    best = x;
                }
            }
        triangulation.move(v, best);
    }
}

/// Smallest angle inside around any of some vertices. [rad]
double worst_angle_at(const PanelTriangulation& triangulation, const std::vector<Vertex>& vertices)
{
    double worst = 4.0;
    for (const Vertex v : vertices)
        triangulation.for_each_face(v, [&](Face f) {
            if (f->info().is_inside)
                worst = std::min(worst, smallest_angle(PanelTriangulation::corners(f)));
        });
    return worst;
}

/// Removes vertices of bad triangles where the smallest angle around grows by that. Puts the others back.
void remove_hindering(PanelTriangulation& triangulation)
{
    std::vector<std::pair<double, Vertex>> bad;
    for (const Vertex v : triangulation.inside())
        if (const double angle = worst_angle_around(triangulation, v, position(v)); angle < kBadAngle)
            bad.emplace_back(angle, v);
    std::stable_sort(bad.begin(), bad.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [angle, v] : bad) {
        std::vector<Vertex> around;
        for_each_neighbour(triangulation, v, [&](Vertex next) { around.push_back(next); });
        const double before = worst_angle_at(triangulation, around);
        const Vec2 x = position(v);
        triangulation.remove({v});
        if (worst_angle_at(triangulation, around) <= before)
            triangulation.insert(x, around[0]->face());
    }
}

} // namespace

struct PanelFill::State {
    PanelTriangulation triangulation;
    std::vector<Vertex> numbered;
    std::vector<Vec2> vertices;
    std::vector<Triangle> triangles;

    State(const PanelFrame& frame, double edge) : triangulation(frame, edge)
    {
        insert_circumcentres(triangulation);
        triangulation.order_in_memory();
        for (int round = 0; round < kRounds; ++round) {
            if (round > 0) {
                remove_crowded(triangulation);
                split_long(triangulation);
            }
            triangulation.propagate_sizes();
            for (int sweep = 0; sweep < kSweeps; ++sweep)
                smooth(triangulation);
        }
        for (int i = 0; i < kPolishes; ++i) {
            polish(triangulation);
            triangulation.flip_to_delaunay();
            if (i % 2 == 0)
                remove_hindering(triangulation);
        }
        read_out();
    }

    void split(const std::vector<std::array<int, 2>>& edges)
    {
        for (const auto& [a, b] : edges)
            triangulation.split_edge(numbered[a], numbered[b]);
        // Flips could bring the edges back.
        for (int i = 0; i < kPolishes; ++i)
            polish(triangulation);
        read_out();
    }

    void read_out()
    {
        numbered = triangulation.number_vertices();
        vertices.clear();
        for (const Vertex v : numbered)
            vertices.push_back(position(v));
        triangles.clear();
        for (const Face f : triangulation.inside_faces()) {
            Triangle t(f->vertex(0)->info().index, f->vertex(1)->info().index, f->vertex(2)->info().index);
            while (t[0] != t.minCoeff())
                t = Triangle(t[1], t[2], t[0]);
            triangles.push_back(t);
        }
        std::sort(triangles.begin(), triangles.end(), [](const Triangle& a, const Triangle& b) {
            return std::tie(a[0], a[1], a[2]) < std::tie(b[0], b[1], b[2]);
        });
    }
};

std::vector<std::array<int, 2>> edges_of(const PanelFrame& frame)
{
    std::vector<std::array<int, 2>> edges = frame.inner_edges;
    for (int i = 0; i < frame.outline_count; ++i)
        edges.push_back({i, (i + 1) % frame.outline_count});
    return edges;
}

PanelFill::PanelFill(const PanelFrame& frame, double edge) : state_(std::make_unique<State>(frame, edge)) {}
PanelFill::~PanelFill() = default;
PanelFill::PanelFill(PanelFill&&) noexcept = default;
PanelFill& PanelFill::operator=(PanelFill&&) noexcept = default;

void PanelFill::split(const std::vector<std::array<int, 2>>& edges) { state_->split(edges); }
const std::vector<Vec2>& PanelFill::vertices() const { return state_->vertices; }
const std::vector<Triangle>& PanelFill::triangles() const { return state_->triangles; }

} // namespace toile::garment
