#include "volume/mesh/slivers.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/volume/blocks.h"
#include "volume/mesh/quality.h"

namespace toile::test {

using namespace volume;

namespace {

TetMesh block() { return make_block(Vec3::Constant(0.3), {3, 3, 3}).mesh; }

TEST(Slivers, LeaveAGoodMeshAsItIs)
{
    TetMesh mesh = block();
    improve_slivers(mesh);
    EXPECT_EQ(mesh.positions, block().positions);
    EXPECT_EQ(mesh.tets, block().tets);
}

TEST(Slivers, AreOpenedWithoutChangingTheBody)
{
    const Block whole = make_block(Vec3::Constant(0.3), {3, 3, 3});
    TetMesh mesh = whole.mesh;
    mesh.positions[whole.at(1, 1, 1)] += 0.098 * Vec3(1.0, 0.0, 0.0); // edges are of 0.1 m
    ASSERT_LT(quality_of(mesh).smallest_dihedral, 2.0);
    ASSERT_EQ(quality_of(mesh).inverted, 0);
    improve_slivers(mesh);
    EXPECT_GT(quality_of(mesh).smallest_dihedral, kSliver);
    EXPECT_NEAR(quality_of(mesh).volume, 0.027, 1e-12);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        int planes = 0; // of the block's surface
        for (const double x : whole.mesh.positions[v])
            planes += x == 0.0 || x == whole.size.x() ? 1 : 0;
        if (planes >= 2) {
            EXPECT_EQ(mesh.positions[v], whole.mesh.positions[v]) << "at an edge of the block: " << v;
        }
    }
}

TEST(Slivers, ArePeeledOffTheSurface)
{
    TetMesh mesh = block();
    const std::vector<Triangle> surface = boundary_triangles(mesh.tets);
    const Triangle& one = surface.front();
    for (const Triangle& other : surface)
        for (int k = 0; k < 3; ++k) {
            const int a = one[k], b = one[(k + 1) % 3], c = one[(k + 2) % 3];
            const auto is_at = [&](int v) { return std::count(other.begin(), other.end(), v) == 1; };
            if (mesh.tets.size() > block().tets.size() || !is_at(a) || !is_at(b) || is_at(c))
                continue;
            const int d = *std::find_if(other.begin(), other.end(), [&](int v) { return v != a && v != b; });
            const Vec3 &p = mesh.positions[a], &q = mesh.positions[b];
            const Vec3 out = (q - p).cross(mesh.positions[c] - p).normalized();
            if (std::abs(out.dot(mesh.positions[d] - p)) > 1e-12)
                continue;
            mesh.positions[a] -= 1e-4 * out; // the tetrahedron fills the valley at the edge from a to b
            mesh.tets.push_back({a, b, c, d});
        }
    ASSERT_EQ(mesh.tets.size(), block().tets.size() + 1);
    orient(
        mesh, [](int) { return ""; }, "block");
    ASSERT_LT(quality_of(mesh).smallest_dihedral, 1.0);
    improve_slivers(mesh);
    EXPECT_EQ(mesh.tets, block().tets);
    EXPECT_NEAR(quality_of(mesh).volume, 0.027, 1e-6);
}

} // namespace
} // namespace toile::test
