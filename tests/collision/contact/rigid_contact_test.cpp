#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "collision/ccd/collision_free_step.h"
#include "collision/check/find_crossings.h"

namespace toile::test {

using namespace collision;

namespace {

/// Tetrahedron of body 0 above one of body 1 above a free triangle, 1 cm between each.
struct Layers {
    std::vector<Vec3> x;
    std::vector<Triangle> triangles{{8, 9, 10}};
    std::vector<int> rigid{0, 0, 0, 0, 1, 1, 1, 1, -1, -1, -1};

    Layers()
    {
        for (int body = 0; body < 2; ++body) {
            for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0.3, 0.3, 0.3)})
                x.push_back(corner + (body == 0 ? 0.31 : 0.0) * Vec3::UnitY());
            for (const Triangle& t :
                 {Triangle(0, 2, 1), Triangle(0, 1, 3), Triangle(1, 2, 3), Triangle(2, 0, 3)})
                triangles.push_back(t + Triangle::Constant(4 * body));
        }
        for (const Vec3& corner : {Vec3(0, -0.01, 0), Vec3(0, -0.01, 1), Vec3(1, -0.01, 0)})
            x.push_back(corner);
    }

    std::vector<NearPair> pairs(const std::vector<Vec3>& motion, double slack,
                                const std::vector<int>& bodies) const
    {
        const std::vector<double> slacks(x.size(), slack);
        std::vector<NearPair> found;
        NearPairs(triangles, x, bodies).find(x, {motion, slacks}, 0.001, found);
        return found;
    }

    /// Positions after CollisionFreeStep limits x + motion, with no motion expected.
    std::vector<Vec3> limited(const std::vector<Vec3>& motion) const
    {
        NearPairs near(triangles, x, rigid);
        const ExemptPairs exempt(x, std::vector<double>(x.size(), 1.0), 2e-6);
        CollisionFreeStep free_step(near, exempt, {}, RigidTrajectories(rigid, {1000.0, 1000.0}));
        const std::vector<double> slack(x.size(), 1e-4);
        const std::vector<unsigned char> fixed(x.size(), 0);
        free_step.begin(x, x, slack, fixed, {});
        std::vector<Vec3> end = x;
        for (size_t v = 0; v < x.size(); ++v)
            end[v] += motion[v];
        free_step.limit(end);
        return end;
    }

    /// Rotates the vertices from first on about the middle of the first, by an angle about an axis [rad], and
    /// translates them.
    std::vector<Vec3> motion_of(int first, const Vec3& rotation, const Vec3& move) const
    {
        std::vector<Vec3> motion(x.size(), Vec3::Zero());
        const Mat3 R = Eigen::AngleAxisd(rotation.norm(), rotation.normalized()).toRotationMatrix();
        for (int v = first; v < first + 4; ++v)
            motion[v] = R * (x[v] - x[first]) + x[first] - x[v] + move;
        return motion;
    }
};

/// Max change of a distance between two vertices of a body [m].
double deformation(const std::vector<Vec3>& x, const std::vector<Vec3>& rest, int first)
{
    double max_change = 0.0;
    for (int a = first; a < first + 4; ++a)
        for (int b = first; b < a; ++b)
            max_change = std::max(max_change, std::abs((x[a] - x[b]).norm() - (rest[a] - rest[b]).norm()));
    return max_change;
}

TEST(RigidContact, FindsNoPairsWithinABody)
{
    const Layers layers;
    const std::vector<Vec3> still(layers.x.size(), Vec3::Zero());
    const size_t all = layers.pairs(still, 0.006, layers.rigid).size();
    EXPECT_LT(all, layers.pairs(still, 0.5, {}).size());
    // Both tetrahedra as one body: only pairs with the triangle remain.
    const std::vector<NearPair> some = layers.pairs(still, 0.006, {0, 0, 0, 0, 0, 0, 0, 0, -1, -1, -1});
    EXPECT_LT(some.size(), all);
    EXPECT_GT(some.size(), 0u);
    for (const NearPair& pair : some)
        EXPECT_TRUE(pair.vertex[0] >= 8 || pair.vertex[3] >= 8);
}

/// The upper body would rotate by half a radian, through the lower one.
TEST(RigidContact, LimitsARotatingBodyAsAWhole)
{
    const Layers layers;
    const std::vector<Vec3> motion = layers.motion_of(0, Vec3(0.5, 0.0, 0.2), Vec3(0.05, 0.1, 0.0));
    std::vector<Vec3> unlimited = layers.x;
    for (size_t v = 0; v < motion.size(); ++v)
        unlimited[v] += motion[v];
    ASSERT_FALSE(find_crossings(layers.triangles, unlimited).empty());

    const std::vector<Vec3> x = layers.limited(motion);
    const double fraction = (x[2] - layers.x[2]).norm() / motion[2].norm();
    EXPECT_GT(fraction, 0.02);
    EXPECT_LT(fraction, 0.98);
    EXPECT_LT(deformation(x, layers.x, 0), 1e-15);
    for (int k = 0; k <= 8; ++k) {
        std::vector<Vec3> between(x.size());
        for (size_t v = 0; v < x.size(); ++v)
            between[v] = layers.x[v] + k / 8.0 * (x[v] - layers.x[v]);
        EXPECT_TRUE(find_crossings(layers.triangles, between).empty()) << k;
    }
}

/// A body lands on cloth: the cloth yields, and no corner of the body moves by itself.
TEST(RigidContact, LetsClothYieldToABody)
{
    Layers layers;
    for (int v = 8; v < 11; ++v)
        layers.x[v].y() = -0.0005;
    std::vector<Vec3> motion = layers.motion_of(4, Vec3::UnitX(), Vec3::Zero());
    for (int v = 4; v < 8; ++v)
        motion[v] = Vec3(0.002, -0.0009, 0.0);
    const std::vector<Vec3> x = layers.limited(motion);
    for (int v = 4; v < 8; ++v)
        EXPECT_LT((x[v] - layers.x[v] - motion[v]).norm(), 1e-15);
    EXPECT_LT(x[8].y(), -0.0009);
    EXPECT_TRUE(find_crossings(layers.triangles, x).empty());
}

/// A body and a cloth vertex in one zone move by their common momentum.
TEST(RigidContact, WeighsABodyInAZoneByItsMass)
{
    const std::vector<Vec3> displacements{Vec3(1, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0)};
    const std::vector<ImpactZones::Support> support(3, ImpactZones::Support::kNone);
    ImpactZones zones;
    zones.reset(displacements, support, 0.0);
    zones.set_body(1, Vec3(0, 0, 0.5), 3.0); // body of vertices 1 and 2
    zones.join(0, 1);
    zones.limit_by(0, 0.0);
    zones.close_pass();
    EXPECT_LT((zones.common(1) - Vec3(0.25, 0.0, 0.375)).norm(), 1e-15);
    EXPECT_EQ(zones.motion(0), zones.common(1));
}

} // namespace
} // namespace toile::test
