#include "volume/meshing/fill_surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/mesh/solid_moments.h"
#include "tests/support/refusal.h"
#include "tests/volume/blocks.h"
#include "volume/mesh/quality.h"

namespace toile::test {

using namespace volume;

namespace {

TriangleMesh ball(double radius)
{
    TriangleMesh surface = subdivide(
        {{Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)},
         {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}},
        4);
    for (Vec3& x : surface.positions)
        x *= radius / x.norm();
    return surface;
}

TEST(FillSurface, FillsABallWithGoodTetrahedra)
{
    const TriangleMesh surface = ball(0.1);
    const TetMesh mesh = fill_surface(surface, 0.03, "ball");
    const MeshQuality quality = quality_of(mesh);
    EXPECT_EQ(quality.inverted, 0);
    EXPECT_GT(quality.smallest_dihedral, 7.0);
    EXPECT_NEAR(quality.mean_edge, 0.03, 0.01);
    EXPECT_NEAR(quality.volume / solid_moments(surface, "ball").volume, 1.0, 0.05);
}

TEST(FillSurface, KeepsSharpEdges)
{
    const TriangleMesh box = boundary_surface(make_block({0.1, 0.2, 0.1}, {1, 1, 1}).mesh);
    const TetMesh mesh = fill_surface(box, 0.04, "box");
    EXPECT_NEAR(quality_of(mesh).volume, 0.002, 1e-6);
    EXPECT_GT(quality_of(mesh).smallest_dihedral, 7.0);
}

TEST(FillSurface, FillsAPlateThinnerThanItsCells)
{
    const TriangleMesh plate = boundary_surface(make_block({0.05, 0.05, 0.002}, {1, 1, 1}).mesh);
    const MeshQuality quality = quality_of(fill_surface(plate, 0.02, "plate"));
    EXPECT_NEAR(quality.volume / 5e-6, 1.0, 0.05);
    EXPECT_GT(quality.smallest_dihedral, 7.0);
}

TEST(FillSurface, GivesTheSameMeshTwice)
{
    const TriangleMesh surface = ball(0.1);
    const TetMesh first = fill_surface(surface, 0.04, "ball"), second = fill_surface(surface, 0.04, "ball");
    EXPECT_EQ(first.positions, second.positions);
    EXPECT_EQ(first.tets, second.tets);
}

TEST(FillSurface, RefusesSurfacesWithoutAnInside)
{
    TriangleMesh open = ball(0.1);
    open.triangles.pop_back();
    EXPECT_THROW(fill_surface(open, 0.03, "open"), InvalidInput);
    TriangleMesh turned = ball(0.1);
    for (Triangle& t : turned.triangles)
        std::swap(t[1], t[2]);
    EXPECT_THROW(fill_surface(turned, 0.03, "turned"), InvalidInput);
    TriangleMesh crossing = ball(0.1);
    const int count = crossing.vertex_count(), triangles = crossing.triangle_count();
    for (int v = 0; v < count; ++v)
        crossing.positions.push_back(crossing.positions[v] + Vec3(0.1, 0.0, 0.0));
    for (int t = 0; t < triangles; ++t)
        crossing.triangles.push_back(crossing.triangles[t] + Triangle::Constant(count));
    EXPECT_THROW(fill_surface(crossing, 0.03, "crossing"), InvalidInput);
    EXPECT_THROW(fill_surface(ball(0.1), 1e-5, "fine"), InvalidInput);
}

TEST(FillSurface, RefusesCellsThatAreLargerThanTheSurface)
{
    const TriangleMesh box = boundary_surface(make_block({0.1, 0.2, 0.1}, {1, 1, 1}).mesh);
    EXPECT_EQ(refusal([&] { (void)fill_surface(box, 0.2, "box"); }), "");
    EXPECT_EQ(refusal([&] { (void)fill_surface(box, 0.3, "box"); }),
              "box: cells of 0.3 m are larger than the surface, which is 0.2 m long; four across it are of "
              "0.05 m");
}

} // namespace
} // namespace toile::test
