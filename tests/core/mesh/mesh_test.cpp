#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/mesh/topology.h"
#include "core/mesh/triangle_mesh.h"
#include "core/mesh/weld.h"
#include "tests/core/mesh/meshes.h"
#include "tests/support/refusal.h"

namespace toile::test {

namespace {

using test::message_of;
using test::real_mesh;
using test::tetrahedron;
using test::two_triangles;

double area(const TriangleMesh& mesh)
{
    double sum = 0.0;
    for (const Triangle& t : mesh.triangles)
        sum += 0.5 * (mesh.positions[t[1]] - mesh.positions[t[0]])
                         .cross(mesh.positions[t[2]] - mesh.positions[t[0]])
                         .norm();
    return sum;
}

int border_count(const Topology& topology)
{
    int count = 0;
    for (const Edge& edge : topology.edges)
        count += edge.is_border() ? 1 : 0;
    return count;
}

/// Triangles per undirected edge by brute force: the oracle of build_topology.
std::map<std::pair<int, int>, int> edge_use(const TriangleMesh& mesh)
{
    std::map<std::pair<int, int>, int> use;
    for (const Triangle& t : mesh.triangles)
        for (int k = 0; k < 3; ++k)
            ++use[{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])}];
    return use;
}

/// Mesh with separate corners for each triangle, as in FBX files.
TriangleMesh with_private_corners(const TriangleMesh& mesh)
{
    TriangleMesh split;
    for (const Triangle& t : mesh.triangles) {
        const int first = split.vertex_count();
        for (const int v : t)
            split.positions.push_back(mesh.positions[v]);
        split.triangles.push_back(Triangle(first, first + 1, first + 2));
    }
    return split;
}

} // namespace

TEST(Topology, OfTwoTrianglesFollowsTheDrawing)
{
    const Topology topology = build_topology(two_triangles().triangles, 4, "square");
    ASSERT_EQ(topology.edges.size(), 5u);
    EXPECT_EQ(border_count(topology), 4);
    EXPECT_FALSE(topology.is_closed());

    // Sorted by vertex pair, so the shared edge (0, 1) is the first.
    const Edge& shared = topology.edges[0];
    EXPECT_EQ(shared.vertex, (std::array<int, 2>{0, 1}));
    EXPECT_EQ(shared.triangle, (std::array<int, 2>{0, 1}));
    EXPECT_EQ(shared.opposite, (std::array<int, 2>{2, 3}));
    EXPECT_EQ(topology.triangle_edge[0], (std::array<int, 3>{0, 3, 1}));
    EXPECT_EQ(topology.triangle_edge[1], (std::array<int, 3>{0, 2, 4}));
}

TEST(Topology, OfATetrahedronIsClosed)
{
    const Topology topology = build_topology(tetrahedron().triangles, 4, "tetrahedron");
    EXPECT_EQ(topology.edges.size(), 6u);
    EXPECT_TRUE(topology.is_closed());
    for (int v = 0; v < 4; ++v)
        EXPECT_EQ(topology.corners_of_vertex.of(v).size(), 3) << "vertex " << v;
}

TEST(Topology, ListsCornersPerVertexInAscendingOrder)
{
    const Incidence corners = corners_of_vertices(two_triangles().triangles, 5);
    const auto of = [&](int v) { return std::vector<int>(corners.of(v).begin(), corners.of(v).end()); };
    EXPECT_EQ(of(0), (std::vector<int>{0, 4}));
    EXPECT_EQ(of(1), (std::vector<int>{1, 3}));
    EXPECT_EQ(of(2), (std::vector<int>{2}));
    EXPECT_EQ(of(3), (std::vector<int>{5}));
    EXPECT_EQ(of(4), std::vector<int>{}) << "an isolated vertex has no corner";
}

TEST(Topology, RefusesThreeTrianglesOnAnEdge)
{
    const std::vector<Triangle> book{{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
    EXPECT_EQ(message_of([&] { build_topology(book, 5, "book.obj"); }),
              "book.obj: edge (0, 1) is non-manifold: 3 triangles share it, at most 2 may; split the surface "
              "there");
}

/// A page upright on the seam between two that lie flat, in every order of the three.
TEST(Topology, KeepsTheFlattestPairWhereSurfacesBranch)
{
    TriangleMesh book = two_triangles();
    book.positions.push_back(Vec3(0.5, 1, 0));
    book.triangles.push_back(Triangle(0, 1, 4));
    for (int turn = 0; turn < 3; ++turn) {
        std::rotate(book.triangles.begin(), book.triangles.begin() + 1, book.triangles.end());
        const Topology topology = build_branching_topology(book, "book.obj");
        ASSERT_EQ(topology.edges.size(), 8u);
        for (int t = 0; t < 3; ++t) {
            const Edge& edge = topology.edges[topology.triangle_edge[t][0]];
            EXPECT_EQ(edge.is_border(), book.triangles[t][2] == 4);
            EXPECT_TRUE(edge.triangle[0] == t || edge.triangle[1] == t);
        }
    }
    book.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
    EXPECT_NE(message_of([&] { build_branching_topology(book, "book.obj"); }).find("in the same direction"),
              std::string::npos);
}

TEST(Topology, RefusesAFlippedTriangle)
{
    const std::vector<Triangle> flipped{{0, 1, 2}, {0, 1, 3}};
    EXPECT_EQ(
        message_of([&] { build_topology(flipped, 4, "flipped.obj"); }),
        "flipped.obj: triangles 0 and 1 run edge (0, 1) in the same direction; flip one of them so that "
        "windings agree");
}

TEST(Topology, OfRealMeshesAgreesWithBruteForce)
{
    for (const char* name : {"cloth/cipc_tablecloth.obj", "cloth/cipc_skirt32x128.obj",
                             "colliders/ipc_torus.obj", "bodies/smpl_f_template.obj"}) {
        const auto mesh = real_mesh(name);
        if (!mesh)
            GTEST_SKIP() << "SKIPPED: TOILE_DATA_DIR has no " << name;
        const Topology topology = build_topology(mesh->triangles, mesh->vertex_count(), name);
        const std::map<std::pair<int, int>, int> use = edge_use(*mesh);
        ASSERT_EQ(topology.edges.size(), use.size()) << name;
        for (const Edge& edge : topology.edges) {
            const auto key = std::minmax(edge.vertex[0], edge.vertex[1]);
            ASSERT_EQ(edge.is_border() ? 1 : 2, use.at(key)) << name;
        }
    }
}

TEST(Topology, OfTheRealTableclothAndTorusHasTheKnownCounts)
{
    const auto cloth = real_mesh("cloth/cipc_tablecloth.obj");
    const auto torus = real_mesh("colliders/ipc_torus.obj");
    if (!cloth || !torus)
        GTEST_SKIP() << "SKIPPED: TOILE_DATA_DIR has no cloth/cipc_tablecloth.obj or colliders/ipc_torus.obj";
    const Topology cloth_topology = build_topology(cloth->triangles, cloth->vertex_count(), "cloth");
    EXPECT_EQ(cloth_topology.edges.size(), 42008u);
    EXPECT_EQ(border_count(cloth_topology), 472);
    const Topology torus_topology = build_topology(torus->triangles, torus->vertex_count(), "torus");
    EXPECT_TRUE(torus_topology.is_closed());
    // Euler characteristic of a torus: V - E + F = 0.
    EXPECT_EQ(torus->vertex_count() - int(torus_topology.edges.size()) + torus->triangle_count(), 0);
}

TEST(Weld, JoinsPrivateCornersBackIntoTheSurface)
{
    const TriangleMesh split = with_private_corners(tetrahedron());
    const Welded welded = weld(split, 1e-6);
    EXPECT_EQ(welded.mesh.vertex_count(), 4);
    EXPECT_EQ(welded.mesh.triangle_count(), 4);
    EXPECT_TRUE(build_topology(welded.mesh.triangles, 4, "welded").is_closed());
    for (int v = 0; v < split.vertex_count(); ++v)
        EXPECT_EQ(welded.mesh.positions[welded.welded_of[v]], split.positions[v]);
    for (int v = 0; v < 4; ++v) {
        EXPECT_EQ(split.positions[welded.source_of[v]], welded.mesh.positions[v]);
        EXPECT_EQ(welded.welded_of[welded.source_of[v]], v);
    }
}

TEST(Weld, MergesUpToTheDistanceAcrossCellBordersAndKeepsTheLowestIndex)
{
    TriangleMesh mesh;
    // 1 and 2 lie 0.8 distances from 0, on both sides and in other grid cells; 3 lies 1.2 away.
    mesh.positions = {{0.0, 0.0, 0.0}, {-0.008, 0.0, 0.0}, {0.0, 0.008, 0.0}, {0.0, 0.0, -0.012}};
    const Welded welded = weld(mesh, 0.01);
    EXPECT_EQ(welded.welded_of, (std::vector<int>{0, 0, 0, 1}));
    EXPECT_EQ(welded.source_of, (std::vector<int>{0, 3}));
    EXPECT_EQ(welded.mesh.positions[0], mesh.positions[0]);
}

TEST(Weld, DoesNotChain)
{
    TriangleMesh mesh;
    mesh.positions = {{0.0, 0.0, 0.0}, {0.008, 0.0, 0.0}, {0.016, 0.0, 0.0}};
    EXPECT_EQ(weld(mesh, 0.01).welded_of, (std::vector<int>{0, 0, 1}));
}

TEST(Weld, OfDistanceZeroMergesEqualPositionsOnly)
{
    TriangleMesh mesh;
    mesh.positions = {{0.1, 0.2, 0.3}, {0.1, 0.2, 0.3}, {0.1, 0.2, 0.3 + 1e-15}};
    EXPECT_EQ(weld(mesh, 0.0).welded_of, (std::vector<int>{0, 0, 1}));
}

TEST(Weld, DropsTrianglesThatLoseACorner)
{
    TriangleMesh mesh = two_triangles();
    mesh.positions[3] = mesh.positions[1];
    const Welded welded = weld(mesh, 1e-9);
    ASSERT_EQ(welded.mesh.triangle_count(), 1);
    EXPECT_EQ(welded.mesh.triangles[0], Triangle(0, 1, 2));
}

TEST(Subdivide, QuartersTrianglesAndSharesMidpoints)
{
    const TriangleMesh coarse = tetrahedron();
    const TriangleMesh fine = subdivide(coarse, 2);
    EXPECT_EQ(fine.triangle_count(), 4 * 16);
    EXPECT_EQ(fine.vertex_count(), 4 + 6 + 24); // one new vertex per edge and level
    EXPECT_TRUE(build_topology(fine.triangles, fine.vertex_count(), "fine").is_closed());
    EXPECT_NEAR(area(fine), area(coarse), 1e-14);
    for (int v = 0; v < coarse.vertex_count(); ++v)
        EXPECT_EQ(fine.positions[v], coarse.positions[v]) << "old vertices keep their index";
}

TEST(Subdivide, KeepsTheWinding)
{
    const TriangleMesh fine = subdivide(two_triangles(), 1);
    for (const Triangle& t : fine.triangles) {
        const Vec3 normal =
            (fine.positions[t[1]] - fine.positions[t[0]]).cross(fine.positions[t[2]] - fine.positions[t[0]]);
        EXPECT_GT(normal.y(), 0.0);
    }
}

TEST(Subdivide, OfNoLevelChangesNothing)
{
    EXPECT_EQ(subdivide(tetrahedron(), 0).triangles, tetrahedron().triangles);
}

TEST(VertexNormals, OfAnOctahedronPointOutwards)
{
    TriangleMesh mesh;
    mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    const std::vector<Vec3> normals = vertex_normals(mesh.positions, mesh.triangles);
    for (int v = 0; v < 6; ++v)
        EXPECT_LT((normals[v] - mesh.positions[v]).norm(), 1e-15) << "vertex " << v;
}

TEST(VertexNormals, WeighByArea)
{
    // At the edge's ends: a triangle of area 1/2 facing +y and one of area 3/2 facing +z.
    const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 0, -1}, {0, 3, 0}, {9, 9, 9}};
    const std::vector<Triangle> triangles{{0, 1, 2}, {0, 1, 3}};
    const std::vector<Vec3> normals = vertex_normals(positions, triangles);
    EXPECT_LT((normals[0] - Vec3(0, 1, 3).normalized()).norm(), 1e-15);
    EXPECT_EQ(normals[4], Vec3(0, 0, 0)) << "an isolated vertex has none";
}

TEST(Bounds, EncloseThePoints)
{
    const std::vector<Vec3> points{{1, 2, 3}, {-1, 5, 3}, {0, 0, 5}};
    const Bounds box = bounds(points);
    EXPECT_EQ(box.lower, Vec3(-1, 0, 3));
    EXPECT_EQ(box.upper, Vec3(1, 5, 5));
    EXPECT_EQ(box.center(), Vec3(0, 2.5, 4));
    EXPECT_DOUBLE_EQ(box.diagonal(), std::sqrt(4.0 + 25.0 + 4.0));
    EXPECT_TRUE(Bounds().empty());
    EXPECT_EQ(Bounds().diagonal(), 0.0);
}

TEST(RequireUsable, AcceptsAGoodMesh) { EXPECT_NO_THROW(require_usable(tetrahedron(), "tetrahedron")); }

TEST(RequireUsable, NamesTheDefect)
{
    const auto refusal = [](const TriangleMesh& mesh) {
        return message_of([&] { require_usable(mesh, "bad.obj"); });
    };
    TriangleMesh mesh = two_triangles();
    mesh.triangles.clear();
    EXPECT_EQ(refusal(mesh), "bad.obj: the mesh has no triangle; a surface needs at least one face");

    mesh = two_triangles();
    mesh.positions[2].y() = std::nan("");
    EXPECT_EQ(refusal(mesh), "bad.obj: vertex 2 is not finite; every coordinate must be a number");

    mesh = two_triangles();
    mesh.triangles[1][2] = 4;
    EXPECT_EQ(refusal(mesh), "bad.obj: triangle 1 uses vertex 4; the mesh has vertices 0 to 3");
    mesh.triangles[1][2] = -1;
    EXPECT_EQ(refusal(mesh), "bad.obj: triangle 1 uses vertex -1; the mesh has vertices 0 to 3");

    mesh = two_triangles();
    mesh.triangles[1] = Triangle(1, 0, 1);
    EXPECT_EQ(refusal(mesh), "bad.obj: triangle 1 uses a vertex twice; remove the triangle");
}

TEST(RequireUsable, RefusesTrianglesBelowTheMinHeight)
{
    TriangleMesh mesh;
    mesh.triangles = {{0, 1, 2}};
    mesh.positions = {{0, 0, 0}, {2, 0, 0}, {1, 2 * 1.1 * kMinHeightRatio, 0}};
    EXPECT_NO_THROW(require_usable(mesh, "thin"));
    mesh.positions[2].y() = 2 * 0.9 * kMinHeightRatio;
    EXPECT_EQ(message_of([&] { require_usable(mesh, "thin"); }),
              "thin: triangle 0 has no area (height below 1e-6 of its longest edge); remove it or merge its "
              "vertices");
}

} // namespace toile::test
