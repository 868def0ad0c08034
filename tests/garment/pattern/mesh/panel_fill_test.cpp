#include "garment/pattern/mesh/panel_fill.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "core/mesh/topology.h"

namespace toile::garment::test {

namespace {

using Polygon = std::vector<Vec2>;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

double polygon_area(const Polygon& polygon)
{
    double twice = 0.0;
    for (size_t i = 0; i < polygon.size(); ++i)
        twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
    return 0.5 * twice;
}

PanelFrame frame_of(const Polygon& polygon) { return {polygon, int(polygon.size()), {}}; }

/// Points every `edge` [m] along the sides of a polygon.
Polygon divided(const Polygon& corners, double edge)
{
    Polygon result;
    for (size_t i = 0; i < corners.size(); ++i) {
        const Vec2 &a = corners[i], &b = corners[(i + 1) % corners.size()];
        const int count = std::max(1, int(std::ceil((b - a).norm() / edge)));
        for (int k = 0; k < count; ++k)
            result.push_back(a + (b - a) * k / count);
    }
    return result;
}

/// Star-shaped polygon with random radii: concave, with corners of all angles.
Polygon random_star(unsigned seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> radius(0.05, 0.5);
    const int corners = 5 + int(seed % 9);
    Polygon polygon;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / corners;
        polygon.push_back(radius(random) * Vec2(std::cos(angle), std::sin(angle)));
    }
    return polygon;
}

/// The triangulation covers the polygon once, keeps its sides and has no others at its border.
void expect_fills(const PanelFill& fill, const Polygon& polygon)
{
    ASSERT_GE(fill.vertices().size(), polygon.size());
    for (size_t i = 0; i < polygon.size(); ++i)
        ASSERT_EQ(fill.vertices()[i], polygon[i]);
    double area = 0.0;
    for (const Triangle& t : fill.triangles()) {
        const Vec2 &a = fill.vertices()[t[0]], &b = fill.vertices()[t[1]], &c = fill.vertices()[t[2]];
        EXPECT_GT(cross(b - a, c - a), 0.0);
        area += 0.5 * cross(b - a, c - a);
    }
    EXPECT_NEAR(area, polygon_area(polygon), 1e-12);

    const int n = int(polygon.size());
    const Topology topology = build_topology(fill.triangles(), int(fill.vertices().size()), "fill");
    int border = 0;
    for (const Edge& edge : topology.edges)
        if (edge.is_border()) {
            ++border;
            EXPECT_EQ((edge.vertex[0] + 1) % n, edge.vertex[1]) << "border edges are sides of the polygon";
        }
    EXPECT_EQ(border, n);
    EXPECT_EQ(int(fill.vertices().size()) - int(topology.edges.size()) + int(fill.triangles().size()), 1);
}

TEST(PanelFill, FillsPolygonsOfAnyShape)
{
    for (unsigned seed = 0; seed < 60; ++seed) {
        SCOPED_TRACE(seed);
        const double edge = seed % 3 == 0 ? 0.02 : 0.05;
        const Polygon polygon = divided(random_star(seed), edge);
        expect_fills(PanelFill(frame_of(polygon), edge), polygon);
    }
}

TEST(PanelFill, FillsATriangleWithItself)
{
    const Polygon polygon{{0.0, 0.0}, {1.0, 0.0}, {0.5, 0.8}};
    const PanelFill fill(frame_of(polygon), 1.0);
    ASSERT_EQ(fill.triangles().size(), 1u);
    EXPECT_EQ(fill.triangles()[0], Triangle(0, 1, 2));
}

TEST(PanelFill, KeepsVerySharpCornersAndThinPlaces)
{
    const double edge = 0.02;
    for (const double width : {0.1, 0.01, 0.001, 1e-5}) {
        const Polygon polygon = divided({{0.0, 0.0}, {0.5, -0.5 * width}, {0.5, 0.5 * width}}, edge);
        expect_fills(PanelFill(frame_of(polygon), edge), polygon);
    }
}

TEST(PanelFill, GrowsFromAFineSide)
{
    // One side of a square has ten times as many points.
    const double edge = 0.05;
    Polygon polygon = divided({{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}}, edge);
    polygon.resize(polygon.size() - size_t(std::ceil(std::sqrt(2.0) / edge)));
    for (int i = 0; i < 20; ++i)
        polygon.emplace_back(1.0 - 0.05 * i, 1.0);
    for (int i = 0; i < 200; ++i)
        polygon.emplace_back(0.0, 1.0 - 0.005 * i);
    const PanelFill fill(frame_of(polygon), edge);
    expect_fills(fill, polygon);
    for (const Triangle& t : fill.triangles()) {
        const Vec2 &a = fill.vertices()[t[0]], &b = fill.vertices()[t[1]], &c = fill.vertices()[t[2]];
        const Vec2 middle = (a + b + c) / 3.0;
        if (std::abs(middle.y() - 0.5) > 0.3)
            continue; // the coarse sides end at the fine one
        const double longest = std::max({(a - b).norm(), (b - c).norm(), (c - a).norm()});
        const double size = std::min(edge, 0.005 + 0.3 * middle.x());
        EXPECT_LT(longest, 1.8 * size);
        EXPECT_GT(longest, 0.6 * size);
    }
}

TEST(PanelFill, SplitsAnEdgeInTheMiddle)
{
    const Polygon polygon{{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}};
    PanelFill fill(frame_of(polygon), 1.0);
    ASSERT_EQ(fill.triangles().size(), 2u);
    const bool is_rising =
        (fill.triangles()[0].array() == 2).any() && (fill.triangles()[1].array() == 2).any();
    fill.split({is_rising ? std::array{0, 2} : std::array{1, 3}});
    expect_fills(fill, polygon);
    ASSERT_EQ(fill.vertices().size(), 5u);
    EXPECT_LT((fill.vertices()[4] - Vec2(0.5, 0.5)).norm(), 0.1);
}

TEST(PanelFill, NumbersNeighboursNearEachOther)
{
    const Polygon polygon = divided({{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}, 0.02);
    const PanelFill fill(frame_of(polygon), 0.02);
    const int inside = int(polygon.size());
    for (const Triangle& t : fill.triangles())
        for (int k = 0; k < 3; ++k)
            if (t[k] >= inside && t[(k + 1) % 3] >= inside) {
                EXPECT_LT(std::abs(t[k] - t[(k + 1) % 3]), 200) << "two rows of 50";
            }
}

} // namespace

} // namespace toile::garment::test
