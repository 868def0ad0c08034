#include "volume/mesh/tet_mesh.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/mesh/solid_moments.h"
#include "core/mesh/topology.h"
#include "tests/volume/blocks.h"
#include "volume/energy/rest_tets.h"

namespace toile::test {

using namespace volume;

namespace {

TEST(TetMesh, OfABlockHasAClosedSurfaceOfItsVolume)
{
    const Block block = make_block({1.0, 2.0, 3.0}, {3, 4, 5}, 0.2);
    double volume = 0.0;
    for (const Tet& tet : block.mesh.tets) {
        EXPECT_GT(volume_of(tet, block.mesh.positions), 0.0);
        volume += volume_of(tet, block.mesh.positions);
    }
    EXPECT_NEAR(volume, 6.0, 1e-13);
    const TriangleMesh surface = boundary_surface(block.mesh);
    EXPECT_EQ(surface.triangle_count(), 4 * (3 * 4 + 4 * 5 + 5 * 3));
    EXPECT_TRUE(build_topology(surface.triangles, surface.vertex_count(), "block").is_closed());
    EXPECT_NEAR(solid_moments(surface, "block").volume, 6.0, 1e-13);
}

TEST(TetMesh, HasItsSurfaceWithoutTheVerticesInside)
{
    const Block block = make_block({1.0, 1.0, 1.0}, {3, 3, 3});
    const TriangleMesh surface = boundary_surface(block.mesh);
    EXPECT_EQ(surface.vertex_count(), 64 - 8);
    for (const Vec3& x : surface.positions)
        EXPECT_TRUE(x.minCoeff() == 0.0 || x.maxCoeff() == 1.0) << x.transpose();
}

TEST(RestTets, HaveTheMassOfTheVolume)
{
    const Block block = make_block({1.0, 2.0, 3.0}, {3, 2, 2}, 0.2);
    const RestTets rest = rest_tets(block.mesh, "block");
    double sum = 0.0;
    for (const double volume : rest.vertex_volumes())
        sum += volume;
    EXPECT_NEAR(sum, 6.0, 1e-13);
}

TEST(RestTets, RefuseSlivers)
{
    TetMesh mesh{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0.3, 0.3, 1e-8)}, {{0, 1, 2, 3}}};
    EXPECT_THROW(rest_tets(mesh, "sliver"), InvalidInput);
    mesh.positions[3].z() = 1e-3;
    EXPECT_NO_THROW(rest_tets(mesh, "sliver"));
}

} // namespace
} // namespace toile::test
