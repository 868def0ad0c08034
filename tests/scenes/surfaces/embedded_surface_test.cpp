#include "scenes/surfaces/embedded_surface.h"

#include <gtest/gtest.h>

#include <random>

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
    std::vector<Vec3> moved;
    for (const Vec3& x : block.mesh.positions)
        moved.push_back(A * x + b);
    const std::vector<Vec3> now = surface.at(moved);
    ASSERT_EQ(now.size(), points.size());
    for (size_t k = 0; k < points.size(); ++k)
        EXPECT_LT((now[k] - (A * points[k] + b)).norm(), 1e-14) << k;
}

TEST(EmbeddedSurface, MovesWithTheTetrahedraAroundItAlone)
{
    // Only the cells on the far side are moved.
    const Block block = make_block(Vec3::Constant(0.1), {4, 4, 4});
    const std::vector<Vec3> points{{0.02, 0.05, 0.05}, {0.098, 0.05, 0.05}, {0.102, 0.05, 0.05}};
    std::vector<Vec3> moved = block.mesh.positions;
    for (Vec3& x : moved)
        if (x.x() > 0.07)
            x.y() += 0.01;
    const std::vector<Vec3> now = EmbeddedSurface(points, block.mesh, "skin.obj").at(moved);
    EXPECT_LT((now[0] - points[0]).norm(), 1e-15);
    EXPECT_LT((now[1] - points[1] - Vec3(0.0, 0.01, 0.0)).norm(), 1e-15);
    EXPECT_LT((now[2] - points[2] - Vec3(0.0, 0.01, 0.0)).norm(), 1e-15);
}

TEST(EmbeddedSurface, TakesTheTetrahedronAroundEachPointOfManyTetrahedra)
{
    // Only the vertices of one cell after the other are moved: points elsewhere stay.
    const Block block = make_block(Vec3::Constant(1.0), {5, 5, 5}, 0.2);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> weight(0.05, 1.0);
    std::vector<Vec3> points;
    for (const volume::Tet& tet : block.mesh.tets) {
        Eigen::Vector4d w(weight(random), weight(random), weight(random), weight(random));
        w /= w.sum();
        Vec3& p = points.emplace_back(Vec3::Zero());
        for (int k = 0; k < 4; ++k)
            p += w[k] * block.mesh.positions[size_t(tet[size_t(k)])];
    }
    const EmbeddedSurface surface(points, block.mesh, "skin.obj");
    for (size_t t = 0; t < points.size(); t += 13) {
        std::vector<Vec3> moved = block.mesh.positions;
        for (const int v : block.mesh.tets[t])
            moved[size_t(v)] += Vec3(0.0, 0.0, 1.0);
        EXPECT_LT((surface.at(moved)[t] - points[t] - Vec3(0.0, 0.0, 1.0)).norm(), 1e-12) << t;
    }
}

TEST(EmbeddedSurface, IsNotCarriedOffBySlivers)
{
    // A tetrahedron with a sliver of height 1e-5 m on its top. Its apex moves by 1 mm.
    volume::TetMesh mesh;
    mesh.positions = {
        {0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.0, 0.1}, {0.03, -0.1, 0.03}, {0.03, 1e-5, 0.03}};
    mesh.tets = {{0, 1, 2, 3}, {0, 2, 1, 4}};
    const std::vector<Vec3> points{{0.03, 0.01, 0.03}, {0.03, 5e-6, 0.03}};
    const EmbeddedSurface surface(points, mesh, "skin.obj");
    EXPECT_LT((surface.at(mesh.positions)[0] - points[0]).norm(), 1e-15);
    std::vector<Vec3> moved = mesh.positions;
    moved[4].y() += 1e-3;
    EXPECT_LT((surface.at(moved)[0] - points[0]).norm(), 2e-3);
    EXPECT_GT((surface.at(moved)[1] - points[1]).norm(), 1e-4) << "inside of the sliver it moves with that";
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
