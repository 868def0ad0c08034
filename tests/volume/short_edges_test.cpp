#include "volume/mesh/short_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/volume/blocks.h"
#include "volume/mesh/quality.h"

namespace toile::test {

using namespace volume;

namespace {

constexpr double kShort = 0.01; // [m] edges of the block are of 0.1 m

Block block() { return make_block(Vec3::Constant(0.3), {3, 3, 3}); }

/// The block with a vertex moved to 2 mm beside another, and the short edge collapsed.
TetMesh collapsed(int vertex, int other)
{
    TetMesh mesh = block().mesh;
    const Vec3 to_other = mesh.positions[other] - mesh.positions[vertex];
    mesh.positions[vertex] += 0.98 * to_other;
    EXPECT_EQ(quality_of(mesh).inverted, 0);
    EXPECT_NEAR(quality_of(mesh).volume, 0.027, 1e-12);
    collapse_short_edges(mesh, kShort);
    return mesh;
}

double shortest_edge(const TetMesh& mesh)
{
    double shortest = std::numeric_limits<double>::infinity();
    for (const Tet& tet : mesh.tets)
        for (int i = 0; i < 4; ++i)
            for (int j = i + 1; j < 4; ++j)
                shortest = std::min(shortest, (mesh.positions[tet[j]] - mesh.positions[tet[i]]).norm());
    return shortest;
}

void expect_block_without_a_vertex(const TetMesh& mesh)
{
    EXPECT_EQ(mesh.vertex_count(), block().mesh.vertex_count() - 1);
    EXPECT_GT(shortest_edge(mesh), kShort);
    const MeshQuality quality = quality_of(mesh);
    EXPECT_EQ(quality.inverted, 0);
    EXPECT_NEAR(quality.volume, 0.027, 1e-12);
    EXPECT_GT(quality.smallest_dihedral, 8.0);
    const TriangleMesh surface = boundary_surface(mesh);
    EXPECT_EQ(surface.vertex_count() - int(surface.triangles.size()) / 2, 2) << "Euler's formula";
}

TEST(ShortEdges, AreNotFoundInAGoodMesh)
{
    TetMesh mesh = block().mesh;
    collapse_short_edges(mesh, kShort);
    EXPECT_EQ(mesh.positions, block().mesh.positions);
    EXPECT_EQ(mesh.tets, block().mesh.tets);
}

TEST(ShortEdges, CollapseInside)
{
    const Block b = block();
    expect_block_without_a_vertex(collapsed(b.at(1, 1, 1), b.at(2, 1, 1)));
}

TEST(ShortEdges, CollapseToTheLessFreeEnd)
{
    const Block b = block();
    expect_block_without_a_vertex(collapsed(b.at(0, 1, 1), b.at(0, 0, 1))); // a face's vertex beside an edge
    expect_block_without_a_vertex(collapsed(b.at(1, 1, 1), b.at(0, 1, 1))); // an inner one beside a face
}

/// Collapsed, the rim would be an edge like a knife's.
TEST(ShortEdges, StayAtTheRimOfAPlate)
{
    const TetMesh plate = make_block(Vec3(0.3, 0.3, 0.8 * kShort), {3, 3, 1}).mesh;
    TetMesh mesh = plate;
    collapse_short_edges(mesh, kShort);
    EXPECT_EQ(mesh.tets, plate.tets);
}

/// Filled by a collapse, a dent would swallow what stands in it.
TEST(ShortEdges, StayWhereTheSurfaceWouldCrossItself)
{
    const Block b = block();
    TetMesh mesh = b.mesh;
    mesh.positions[b.at(1, 1, 3)] = Vec3(0.19, 0.1, 0.2992);
    const Vec3 low(0.17, 0.1, 0.2997);
    const int first = mesh.vertex_count();
    for (const Vec3& x :
         {Vec3(0.0, 0.0, 0.0), Vec3(0.001, 0.0, 0.001), Vec3(0.0, 0.001, 0.001), Vec3(0.0, 0.0, 0.001)})
        mesh.positions.push_back(low + x);
    mesh.tets.push_back({first, first + 1, first + 2, first + 3});
    orient(
        mesh, [](int) { return ""; }, "block");
    ASSERT_EQ(quality_of(mesh).inverted, 0);
    collapse_short_edges(mesh, 3.0 * kShort);
    for (const Tet& tet : mesh.tets) {
        const auto stands_in_dent = [&](int v) { return mesh.positions[v].z() >= low.z(); };
        if (std::all_of(tet.begin(), tet.end(), stands_in_dent))
            continue;
        int inside = 0;
        for (int k = 0; k < 4; ++k) {
            std::vector<Vec3> x = mesh.positions;
            x[tet[k]] = low;
            inside += volume_of(tet, x) > 0.0 ? 1 : 0;
        }
        EXPECT_LT(inside, 4);
    }
}

} // namespace

} // namespace toile::test
