#include "core/mesh/winding.h"

#include <gtest/gtest.h>

#include "core/mesh/topology.h"
#include "tests/core/mesh/meshes.h"

namespace toile::test {

namespace {

using test::message_of;

std::string complaint_about(const ObjMesh& mesh)
{
    return message_of(
        [&] { build_topology(mesh.triangulated().triangles, int(mesh.positions.size()), "mesh"); });
}

/// Strip of `count` quads between vertices 2k, 2k + 1 and 2k + 2, 2k + 3, texture indices as the corners.
ObjMesh strip(int count)
{
    ObjMesh mesh;
    for (int k = 0; k <= count; ++k)
        mesh.positions.insert(mesh.positions.end(), {Vec3(k, 0, 0), Vec3(k, 1, 0)});
    for (int k = 0; k < count; ++k)
        mesh.polygons.push_back({2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1});
    mesh.texture_coordinates.assign(mesh.positions.size(), Vec2::Zero());
    mesh.polygon_uvs = mesh.polygons;
    return mesh;
}

TEST(MakeWindingsAgree, LeavesAConsistentMeshUnchanged)
{
    ObjMesh mesh = strip(4);
    EXPECT_EQ(make_windings_agree(mesh), 0);
    EXPECT_EQ(mesh.polygons, strip(4).polygons);
}

TEST(MakeWindingsAgree, FlipsTheMinorityOfEachPiece)
{
    // Faces 0 and 2 of the first piece of 7, all but the first of the second piece of 3.
    ObjMesh mesh = strip(10);
    for (size_t k = 7; k < 10; ++k)
        for (int& v : mesh.polygons[k])
            v += 2;
    mesh.positions.insert(mesh.positions.end(), {Vec3(11, 0, 0), Vec3(11, 1, 0)});
    mesh.polygon_uvs = mesh.polygons;
    const ObjMesh right = mesh;
    for (const int k : {0, 2, 7, 8}) {
        std::swap(mesh.polygons[k][1], mesh.polygons[k][3]);
        std::swap(mesh.polygon_uvs[k][1], mesh.polygon_uvs[k][3]);
    }
    ASSERT_NE(complaint_about(mesh), "");

    EXPECT_EQ(make_windings_agree(mesh), 3) << "0 and 2 of the first piece, 9 of the second";
    EXPECT_EQ(complaint_about(mesh), "");
    EXPECT_EQ(mesh.polygon_uvs, mesh.polygons) << "texture indices turn with their face";
    for (const int k : {0, 1, 2, 6})
        EXPECT_EQ(mesh.polygons[k], right.polygons[k]) << k;
    EXPECT_NE(mesh.polygons[9], right.polygons[9]);
}

/// Pages of a book, all wound alike: the two that lie flat are made to agree.
TEST(MakeWindingsAgree, GoesOnAcrossSeamsOfSewnParts)
{
    ObjMesh book;
    book.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, -1}, {0, 0, 1}, {0, 1, 0}};
    book.polygons = {{0, 1, 4}, {0, 1, 2}, {0, 1, 3}};
    EXPECT_EQ(branching_edges(book), 1);
    EXPECT_EQ(branching_edges(strip(4)), 0);
    EXPECT_EQ(make_windings_agree(book), 1);
    EXPECT_NE(book.polygons[1][1], book.polygons[2][1]);
    EXPECT_FALSE(one_sided_polygons(book));
    const Topology topology = build_branching_topology(book.triangulated(), "book");
    EXPECT_EQ(topology.triangle_edge[1][0] == topology.triangle_edge[2][0] ||
                  topology.triangle_edge[1][0] == topology.triangle_edge[2][2] ||
                  topology.triangle_edge[1][2] == topology.triangle_edge[2][0],
              true);
}

TEST(MakeWindingsAgree, LeavesAMoebiusStripToTheTopologyCheck)
{
    ObjMesh mesh = strip(5);
    mesh.polygons[4] = {8, 1, 0, 9};
    make_windings_agree(mesh);
    EXPECT_NE(complaint_about(mesh).find("in the same direction"), std::string::npos);
    EXPECT_TRUE(one_sided_polygons(mesh));
    EXPECT_FALSE(one_sided_polygons(strip(5)));
}

TEST(MakeWindingsAgree, RepairsARealGarment)
{
    const std::filesystem::path file =
        std::filesystem::path(TOILE_DATA_DIR) / "garments/mh_woman_female_elegantsuit01.obj";
    if (!std::filesystem::exists(file))
        GTEST_SKIP() << "SKIPPED: TOILE_DATA_DIR has no garments/" << file.filename();
    ObjMesh mesh = read_obj(file);
    ASSERT_NE(complaint_about(mesh), "");
    EXPECT_GT(make_windings_agree(mesh), 0);
    EXPECT_EQ(complaint_about(mesh), "");
}

/// Adds a tetrahedron of another size, a corner at the given place.
void add_tetrahedron(TriangleMesh& mesh, const Vec3& corner, double size, bool inside_out)
{
    const TriangleMesh one = tetrahedron();
    const int first = mesh.vertex_count();
    for (const Vec3& p : one.positions)
        mesh.positions.push_back(corner + size * p);
    for (const Triangle& t : one.triangles)
        mesh.triangles.push_back((inside_out ? Triangle(t[0], t[2], t[1]) : t) + Triangle::Constant(first));
}

TEST(FaceOutwards, TurnsWhatIsInsideOut)
{
    TriangleMesh mesh;
    add_tetrahedron(mesh, Vec3::Zero(), 1.0, false);
    const TriangleMesh right = mesh;
    EXPECT_EQ(face_outwards(mesh), 0);

    mesh = {};
    add_tetrahedron(mesh, Vec3::Zero(), 1.0, true);
    EXPECT_EQ(face_outwards(mesh), 4);
    EXPECT_EQ(mesh.triangles, right.triangles);

    std::swap(mesh.triangles[2][1], mesh.triangles[2][2]); // mixed
    EXPECT_EQ(face_outwards(mesh), 1);
    EXPECT_EQ(mesh.triangles, right.triangles);
}

TEST(FaceOutwards, KnowsACavityFromAPartInsideOut)
{
    const auto turned = [](bool outer, bool inner, const Vec3& at) {
        TriangleMesh mesh;
        add_tetrahedron(mesh, Vec3::Zero(), 1.0, outer);
        add_tetrahedron(mesh, at, 0.1, inner);
        return face_outwards(mesh);
    };
    const Vec3 within(0.1, 0.1, 0.1), beside(2.0, 0.0, 0.0);
    EXPECT_EQ(turned(false, true, within), 0) << "a cavity";
    EXPECT_EQ(turned(true, false, within), 8) << "a cavity in a body inside out";
    EXPECT_EQ(turned(false, true, beside), 4);
    EXPECT_EQ(turned(false, false, within), 0) << "eyes in a head";
}

TEST(FaceOutwards, LeavesOpenSurfaces)
{
    TriangleMesh mesh = two_triangles();
    for (Triangle& t : mesh.triangles)
        std::swap(t[1], t[2]);
    EXPECT_EQ(face_outwards(mesh), 0);
}

} // namespace
} // namespace toile::test
