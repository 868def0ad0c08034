#include "scenes/surfaces/embedded_surface.h"

#include <gtest/gtest.h>

#include "tests/support/refusal.h"
#include "tests/volume/blocks.h"

namespace toile::test {

using namespace scenes;

namespace {

TEST(EmbeddedSurface, FollowsAffineMapsInsideAndOutside)
{
    const Block block = make_block(Vec3::Constant(0.1), {3, 3, 3}, 0.2);
    const std::vector<Vec3> points{
        {0.05, 0.05, 0.05}, {0.0, 0.0, 0.0}, {0.1, 0.02, 0.07}, {-0.01, 0.05, 0.05}, {0.11, 0.105, -0.01}};
    const EmbeddedSurface surface(points, block.mesh, "skin.obj");
    Mat3 A;
    A << 1.2, 0.3, 0.0, -0.1, 0.9, 0.2, 0.4, 0.0, 1.1;
    const Vec3 b(1.0, -2.0, 0.5);
    const std::vector<Vec3> now =
        surface.at([&](int v) -> Vec3 { return A * block.mesh.positions[size_t(v)] + b; });
    ASSERT_EQ(now.size(), points.size());
    for (size_t k = 0; k < points.size(); ++k)
        EXPECT_LT((now[k] - (A * points[k] + b)).norm(), 1e-14) << k;
}

TEST(EmbeddedSurface, MovesWithTheTetrahedraAroundItAlone)
{
    // Only the cells on the far side are moved.
    const Block block = make_block(Vec3::Constant(0.1), {4, 4, 4});
    const std::vector<Vec3> points{{0.02, 0.05, 0.05}, {0.098, 0.05, 0.05}, {0.102, 0.05, 0.05}};
    const std::vector<Vec3> now = EmbeddedSurface(points, block.mesh, "skin.obj").at([&](int v) -> Vec3 {
        const Vec3& x = block.mesh.positions[size_t(v)];
        return x + (x.x() > 0.07 ? Vec3(0.0, 0.01, 0.0) : Vec3::Zero());
    });
    EXPECT_LT((now[0] - points[0]).norm(), 1e-15);
    EXPECT_LT((now[1] - points[1] - Vec3(0.0, 0.01, 0.0)).norm(), 1e-15);
    EXPECT_LT((now[2] - points[2] - Vec3(0.0, 0.01, 0.0)).norm(), 1e-15);
}

TEST(EmbeddedSurface, RefusesAVertexThatIsFarOutside)
{
    const Block block = make_block(Vec3::Constant(0.1), {2, 2, 2});
    const std::vector<Vec3> points{{0.0, 0.0, 0.0}, {0.05, 0.25, 0.05}};
    const std::string message = refusal([&] { EmbeddedSurface(points, block.mesh, "skin.obj"); });
    EXPECT_NE(message.find("skin.obj: vertex 1 at (0.05, 0.25, 0.05) m is 0.15 m outside"), std::string::npos)
        << message;
}

} // namespace
} // namespace toile::test
