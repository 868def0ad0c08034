#include "garment/pattern/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/mesh/topology.h"

namespace toile::test {

using namespace garment;

namespace {

constexpr double kPi = std::numbers::pi;

Vec3 doubled_area(const TriangleMesh& mesh, const Triangle& t)
{
    return (mesh.positions[t[1]] - mesh.positions[t[0]]).cross(mesh.positions[t[2]] - mesh.positions[t[0]]);
}

double area(const TriangleMesh& mesh)
{
    double sum = 0.0;
    for (const Triangle& t : mesh.triangles)
        sum += 0.5 * doubled_area(mesh, t).norm();
    return sum;
}

/// Border edges and their length; connectivity as build_topology checks it (manifold, one orientation).
struct Outline {
    int edges = 0;
    double length = 0.0;
    double shortest_edge = 1e9, longest_edge = 0.0; ///< of the whole mesh
    int euler = 0;                                  ///< vertices - edges + triangles
};

Outline outline(const TriangleMesh& mesh)
{
    const Topology topology = build_topology(mesh.triangles, mesh.vertex_count(), "cut");
    Outline result;
    for (const Edge& edge : topology.edges) {
        const double length = (mesh.positions[edge.vertex[0]] - mesh.positions[edge.vertex[1]]).norm();
        result.shortest_edge = std::min(result.shortest_edge, length);
        result.longest_edge = std::max(result.longest_edge, length);
        if (edge.is_border()) {
            ++result.edges;
            result.length += length;
        }
    }
    result.euler = mesh.vertex_count() - int(topology.edges.size()) + int(mesh.triangles.size());
    return result;
}

TEST(CutRectangle, HasItsAreaItsOutlineAndItsResolution)
{
    const TriangleMesh mesh = cut_rectangle(Vec2(0.6, 0.4), 0.05);
    EXPECT_EQ(mesh.vertex_count(), 13 * 9);
    EXPECT_EQ(mesh.triangles.size(), 2u * 12 * 8);
    EXPECT_NEAR(area(mesh), 0.24, 1e-14);
    const Outline border = outline(mesh);
    EXPECT_EQ(border.edges, 2 * (12 + 8));
    EXPECT_NEAR(border.length, 2.0, 1e-13);
    EXPECT_EQ(border.euler, 1) << "one piece without holes";
    EXPECT_NEAR(border.shortest_edge, 0.05, 1e-14);
    for (const Triangle& t : mesh.triangles)
        EXPECT_GT(doubled_area(mesh, t).y(), 0.0) << "faces up";
}

TEST(CutRectangle, IsCentredAndPrefersNoDiagonal)
{
    const TriangleMesh mesh = cut_rectangle(Vec2(0.4, 0.4), 0.1);
    Vec3 sum = Vec3::Zero();
    for (const Vec3& p : mesh.positions)
        sum += p;
    EXPECT_LT(sum.norm(), 1e-14);

    int rising = 0, falling = 0;
    for (const Edge& edge : build_topology(mesh.triangles, mesh.vertex_count(), "cut").edges) {
        const Vec3 along = mesh.positions[edge.vertex[1]] - mesh.positions[edge.vertex[0]];
        rising += along.x() * along.z() > 1e-9 ? 1 : 0;
        falling += along.x() * along.z() < -1e-9 ? 1 : 0;
    }
    EXPECT_EQ(rising, 8);
    EXPECT_EQ(falling, 8);
}

TEST(CutRectangle, IsOneCellAtACoarseResolution)
{
    EXPECT_EQ(cut_rectangle(Vec2(0.1, 0.2), 5.0).vertex_count(), 4);
}

TEST(CutDisc, HasTheAreaAndOutlineOfItsPolygon)
{
    const double radius = 0.3;
    const TriangleMesh mesh = cut_disc(radius, 0.03);
    const int rings = 10, sides = 6 * rings;
    EXPECT_EQ(mesh.vertex_count(), 1 + 3 * rings * (rings + 1));
    EXPECT_EQ(mesh.triangles.size(), 6u * rings * rings);
    EXPECT_NEAR(area(mesh), 0.5 * sides * radius * radius * std::sin(2.0 * kPi / sides), 1e-13);
    const Outline border = outline(mesh);
    EXPECT_EQ(border.edges, sides);
    EXPECT_NEAR(border.length, 2.0 * sides * radius * std::sin(kPi / sides), 1e-13);
    EXPECT_EQ(border.euler, 1);
    EXPECT_GT(border.shortest_edge, 0.03 * 0.8);
    EXPECT_LT(border.longest_edge, 0.03 * 1.5);
    for (const Triangle& t : mesh.triangles)
        EXPECT_GT(doubled_area(mesh, t).y(), 0.0) << "faces up";
}

TEST(CutSkirt, ClosesItsSeamAndOpensAtWaistAndHem)
{
    const SkirtCut cut;
    const TriangleMesh mesh = cut_skirt(cut);
    const Outline border = outline(mesh);
    EXPECT_EQ(border.euler, 0) << "a tube: the seam is closed and there are no holes";

    // The border is waist and hem alone, polygons of their circles.
    EXPECT_NEAR(border.length, 2.0 * kPi * (cut.waist_radius + cut.hem_radius), 1e-3 * border.length);
    const double hem = -std::sqrt(cut.length * cut.length - std::pow(cut.hem_radius - cut.waist_radius, 2));
    for (const Edge& edge : build_topology(mesh.triangles, mesh.vertex_count(), "cut").edges)
        for (const int v : edge.vertex) {
            if (!edge.is_border())
                continue;
            const Vec3& p = mesh.positions[v];
            const bool at_waist = p.y() > 0.5 * hem;
            EXPECT_NEAR(p.y(), at_waist ? 0.0 : hem, 1e-14);
            // The waist is a circle; the hem is one within 0.2 %.
            const double radius = std::hypot(p.x(), p.z());
            if (at_waist)
                EXPECT_NEAR(radius, cut.waist_radius, 1e-14);
            else
                EXPECT_NEAR(radius, cut.hem_radius, 0.002 * cut.hem_radius);
        }
}

TEST(CutSkirt, ApproachesTheAreaOfTheConeFromInside)
{
    SkirtCut cut;
    const double cone = kPi * (cut.waist_radius + cut.hem_radius) * cut.length;
    double previous = 1.0;
    for (const double resolution : {0.06, 0.03, 0.015}) {
        cut.resolution = resolution;
        const double missing = 1.0 - area(cut_skirt(cut)) / cone;
        EXPECT_GT(missing, 0.0);
        EXPECT_LT(missing, 0.35 * previous) << "second order in the resolution";
        previous = missing;
    }
    EXPECT_LT(previous, 1e-3);
}

TEST(CutSkirt, FacesOutwardsWithEdgesNearTheResolution)
{
    const SkirtCut cut;
    const TriangleMesh mesh = cut_skirt(cut);
    for (const Triangle& t : mesh.triangles) {
        const Vec3 n = doubled_area(mesh, t);
        const Vec3 center = (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3.0;
        EXPECT_GT(n.x() * center.x() + n.z() * center.z(), 0.0);
    }
    const Outline border = outline(mesh);
    EXPECT_GT(border.shortest_edge, 0.5 * cut.resolution);
    EXPECT_LT(border.longest_edge, 1.6 * cut.resolution);
}

TEST(CutSkirt, IsACylinderWithoutFlare)
{
    const SkirtCut tube{0.1, 0.1, 0.3, 0.02};
    for (const Vec3& p : cut_skirt(tube).positions)
        EXPECT_NEAR(std::hypot(p.x(), p.z()), 0.1, 0.002 * 0.1);
}

TEST(CutSkirt, RefusesAHemOutOfReach)
{
    EXPECT_THROW(cut_skirt({0.12, 0.62, 0.5, 0.02}), InvalidInput);
    EXPECT_THROW(cut_skirt({0.12, 0.11, 0.5, 0.02}), InvalidInput);
    EXPECT_THROW(cut_skirt({0.12, std::nan(""), 0.5, 0.02}), InvalidInput);
    EXPECT_NO_THROW(cut_skirt({0.12, 0.6, 0.5, 0.05}));
}

} // namespace
} // namespace toile::test
