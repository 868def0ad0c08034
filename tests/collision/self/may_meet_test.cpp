#include "collision/self/pair_rules.h"

#include <random>

#include <gtest/gtest.h>

namespace toile::test {

using namespace collision;

namespace {

constexpr double kEdge = 0.01, kMargin = 1e-3; // [m]

/// A vertex and a triangle, or two edges, on straight trajectories.
struct MovingPair {
    bool is_edge_edge = false;
    std::array<Vec3, 4> x, motion;
    std::array<double, 4> slack{};

    bool may_meet() const
    {
        const Trajectories trajectories{{motion.data(), 4}, {slack.data(), 4}};
        return MayMeet{{x.data(), 4}, trajectories, kMargin, true}({0, 1, 2, 3}, is_edge_edge);
    }
    double distance_at(double time, const std::array<Vec3, 4>& beside) const
    {
        std::array<Vec3, 4> at;
        for (int k = 0; k < 4; ++k)
            at[k] = x[k] + time * (motion[k] + beside[k]);
        return closest_difference(closest_weights(is_edge_edge, at), at).norm();
    }
};

class MayMeetRule : public ::testing::Test {
protected:
    Vec3 point(double size)
    {
        std::uniform_real_distribution<double> in(-size, size);
        return {in(random_), in(random_), in(random_)};
    }

    /// Primitives of the size of an edge, a few edges apart, which pass each other by several edges.
    MovingPair pair()
    {
        MovingPair made;
        made.is_edge_edge = random_() % 2 == 0;
        const int first = first_count(made.is_edge_edge);
        const Vec3 centre[2] = {point(4 * kEdge), point(4 * kEdge)},
                   way[2] = {point(5 * kEdge), point(5 * kEdge)};
        for (int k = 0; k < 4; ++k) {
            made.x[k] = centre[k < first ? 0 : 1] + point(0.5 * kEdge);
            made.motion[k] = way[k < first ? 0 : 1] + point(0.1 * kEdge);
            made.slack[k] = 0.05 * kEdge * double(random_() % 3);
        }
        return made;
    }

    /// Nearest sampled distance on trajectories that end within their slack [m].
    double nearest(const MovingPair& pair)
    {
        constexpr int kTimes = 50;
        double nearest = 1.0;
        for (int turn = 0; turn < 4; ++turn) {
            std::array<Vec3, 4> beside;
            for (int k = 0; k < 4; ++k)
                beside[k] = turn == 0 ? Vec3(Vec3::Zero()) : Vec3(pair.slack[k] * point(1.0).normalized());
            for (int i = 0; i <= kTimes; ++i)
                nearest = std::min(nearest, pair.distance_at(double(i) / kTimes, beside));
        }
        return nearest;
    }

    std::mt19937 random_{1};
};

TEST_F(MayMeetRule, RefusesNoPairThatComesNear)
{
    int near = 0;
    for (int i = 0; i < 50'000; ++i) {
        const MovingPair pair = this->pair();
        if (nearest(pair) > kMargin)
            continue;
        ++near;
        ASSERT_TRUE(pair.may_meet()) << i;
    }
    EXPECT_GT(near, 100);
}

/// Fast bodies would have pairs of everything in the boxes around their motion.
TEST_F(MayMeetRule, RefusesMostPairsThatPassByEachOther)
{
    int near = 0, kept = 0;
    for (int i = 0; i < 20'000; ++i) {
        const MovingPair pair = this->pair();
        near += nearest(pair) <= kMargin ? 1 : 0;
        kept += pair.may_meet() ? 1 : 0;
    }
    EXPECT_LT(kept, 4 * near);
}

TEST_F(MayMeetRule, RefusesAVertexThatPassesBesideATriangle)
{
    MovingPair pair;
    pair.x = {Vec3(-5 * kEdge, kEdge, 0.5 * kEdge), Vec3(0, 0, 0), Vec3(kEdge, 0, 0), Vec3(0, 0, kEdge)};
    pair.motion.fill(Vec3::Zero());
    pair.motion[0] = Vec3(10 * kEdge, 0, 0);
    EXPECT_FALSE(pair.may_meet());
    pair.motion[0] -= Vec3(0, 2 * kEdge, 0); // down through it
    EXPECT_TRUE(pair.may_meet());
}

} // namespace
} // namespace toile::test
