#include <gtest/gtest.h>

#include "collision/cloth/safe_step.h"

namespace toile {
namespace {

/// A triangle of body 0 over one of body 1, 1 cm apart, and a third, free triangle 1 cm below.
struct Layers {
    std::vector<Vec3> x;
    std::vector<Triangle> triangles{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
    std::vector<int> rigid{0, 0, 0, 1, 1, 1, -1, -1, -1};

    Layers()
    {
        for (int layer = 0; layer < 3; ++layer)
            for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(1, 0, 0)})
                x.push_back(corner - 0.01 * layer * Vec3::UnitY());
    }

    std::vector<NearPair> pairs(const std::vector<Vec3>& motion, const std::vector<double>& slack,
                                const std::vector<int>& bodies) const
    {
        std::vector<NearPair> found;
        NearPairs(triangles, x, bodies).find(x, motion, slack, 0.001, found);
        return found;
    }
};

TEST(RigidContact, FindsNoPairsWithinABody)
{
    const Layers layers;
    const std::vector<double> slack(9, 0.006);
    const std::vector<Vec3> still(9, Vec3::Zero());
    const size_t all = layers.pairs(still, slack, layers.rigid).size();
    EXPECT_EQ(all, layers.pairs(still, slack, {}).size());
    // The upper two layers as one body: only what meets the third is left.
    const std::vector<NearPair> some = layers.pairs(still, slack, {0, 0, 0, 0, 0, 0, -1, -1, -1});
    EXPECT_LT(some.size(), all);
    EXPECT_GT(some.size(), 0u);
    for (const NearPair& pair : some)
        EXPECT_TRUE(pair.vertex[0] >= 6 || pair.vertex[3] >= 6);
}

/// One corner of the upper body would go through the middle one: the body stops with all of its corners at
/// one share of their ways.
TEST(RigidContact, HoldsABodyBackAsAWhole)
{
    const Layers layers;
    std::vector<Vec3> motion(9, Vec3::Zero());
    motion[0] = Vec3(0.0, -0.02, 0.0);
    motion[1] = Vec3(0.002, -0.004, 0.0);
    motion[2] = Vec3(0.0, 0.003, 0.001);
    const std::vector<double> slack(9, 0.001);
    const std::vector<NearPair> pairs = layers.pairs(motion, slack, layers.rigid);
    SafeStep safe({}, layers.rigid);
    safe.begin(layers.x, motion, slack, pairs);
    std::vector<Vec3> x = layers.x;
    for (int v = 0; v < 9; ++v)
        x[v] += motion[v];
    EXPECT_GT(safe.limit(x), 0.0);
    const double share = (x[0] - layers.x[0]).norm() / motion[0].norm();
    EXPECT_LT(share, 0.5);
    EXPECT_GT(share, 0.2);
    for (int v = 0; v < 3; ++v)
        EXPECT_LT((x[v] - layers.x[v] - share * motion[v]).norm(), 1e-15);
    EXPECT_GT(x[0].y(), -0.01);
}

TEST(RigidContact, BringsABodyBackToItsSlackAsAWhole)
{
    const Layers layers;
    const std::vector<Vec3> still(9, Vec3::Zero());
    const std::vector<double> slack(9, 0.001);
    SafeStep safe({}, layers.rigid);
    safe.begin(layers.x, still, slack, {});
    std::vector<Vec3> x = layers.x;
    x[0].y() += 0.004;
    x[1].y() += 0.002;
    EXPECT_NEAR(safe.limit(x), 0.003, 1e-12);
    EXPECT_NEAR(x[0].y(), 0.001, 1e-12);
    EXPECT_NEAR(x[1].y(), 0.0005, 1e-12);
}

} // namespace
} // namespace toile
