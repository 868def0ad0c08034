#include "collision/contact_pushes.h"

#include <gtest/gtest.h>

#include <numeric>

#include "collision/host_turns.h"

namespace toile {
namespace {

constexpr double kStiffness = 1e3, kMass = 0.02, kDt = 0.01, kFriction = 0.3;

/// Two vertices, the second above the first, over the plane y = 0.
class ContactPushes : public testing::Test {
protected:
    PushRules rules() const { return {fixed_, rigid_, masses_, altitude_, kDt, 1.0}; }

    /// Of a vertex with the plane.
    static ContactTerm on_plane(int vertex)
    {
        ContactTerm term;
        term.pair.vertex = {vertex, -1, -1, -1};
        term.pair.weight = {1.0, 0.0, 0.0, 0.0};
        term.pair.collider = 0;
        term.spring = {kStiffness, 0.0};
        term.friction = kFriction;
        return term;
    }
    /// Of the second vertex with the first, which are to keep that distance.
    static ContactTerm between(double distance)
    {
        ContactTerm term = on_plane(1);
        term.pair.vertex = {1, 0, -1, -1};
        term.pair.weight = {1.0, -1.0, 0.0, 0.0};
        term.pair.collider = -1;
        term.offset = distance;
        return term;
    }

    std::vector<unsigned char> fixed_ = std::vector<unsigned char>(2, 0);
    std::vector<int> rigid_;
    std::vector<double> masses_ = std::vector<double>(2, kMass), altitude_ = std::vector<double>(2, 0.1);
    std::vector<Vec3> x_{Vec3(0.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0)};
    std::vector<Vec3> v_ = std::vector<Vec3>(2, Vec3::Zero());
    HostTurns turns_;
};

TEST_F(ContactPushes, RestWhereTheSpringHoldsWhatInertiaBringsAndStayThere)
{
    constexpr double kReach = 2e-3, kMobility = kDt * kDt / kMass;
    constexpr double kDepth = kReach / (1.0 + kStiffness * kMobility);
    x_[0].y() = -kReach;
    std::vector<double> force(1, 0.0);
    const std::vector<ContactTerm> terms{on_plane(0)};
    EXPECT_TRUE(turns_.sweep(terms, PushToRest{rules(), force, x_}, 1));
    EXPECT_NEAR(x_[0].y(), -kDepth, 1e-15);
    EXPECT_NEAR(force[0], kStiffness * kDepth, 1e-12);
    const std::vector<Vec3> rest = x_;
    turns_.sweep(terms, PushToRest{rules(), force, x_}, 3);
    EXPECT_NEAR(x_[0].y(), rest[0].y(), 1e-12);
}

TEST_F(ContactPushes, NeverPull)
{
    x_[0].y() = -2e-3;
    std::vector<double> force(1, 0.0);
    const std::vector<ContactTerm> terms{on_plane(0)};
    turns_.sweep(terms, PushToRest{rules(), force, x_}, 1);
    x_[0].y() += 5e-3; // others took it out
    turns_.sweep(terms, PushToRest{rules(), force, x_}, 1);
    EXPECT_EQ(force[0], 0.0);
    EXPECT_NEAR(x_[0].y(), 3e-3, 1e-12) << "as if it had not pushed";
}

TEST_F(ContactPushes, ReachThoseThatASweepPushesOn)
{
    constexpr double kDistance = 3e-3, kDepth = 4e-4, kApart = 3e-4;
    const std::vector<ContactTerm> terms{on_plane(0), between(kDistance)};
    x_[0].y() = -kDepth;
    x_[1].y() = x_[0].y() + kDistance + kApart;
    const double before = x_[1].y();
    EXPECT_TRUE(turns_.sweep(terms, PushOut{rules(), 0.0, x_}, 1));
    EXPECT_NEAR(x_[1].y() - before, 0.5 * (kDepth - kApart), 1e-12);
    EXPECT_NEAR(x_[1].y() - x_[0].y(), kDistance, 1e-12);
}

TEST_F(ContactPushes, HaveTurnsOnlyNearThoseThatPush)
{
    constexpr double kDepth = 1e-4;
    const auto turns_of = [&](double apart, double depth) {
        const std::vector<ContactTerm> terms{on_plane(0), between(0.5)};
        x_ = {Vec3(0.0, -depth, 0.0), Vec3(0.0, -depth + 0.5 + apart, 0.0)};
        const PushOut push{rules(), 0.0, x_};
        std::vector<float> deepest(2, 0.0F);
        std::vector<unsigned char> flags(TurnOrder{2}.place_count());
        for (int i = 0; i < 2; ++i)
            FindDeepest<PushOut>{push, terms, deepest}(i);
        for (int i = 0; i < 2; ++i)
            FlagActing<PushOut>{push, terms, TurnOrder{2}, deepest, flags}(i);
        return std::accumulate(flags.begin(), flags.end(), 0);
    };
    EXPECT_EQ(turns_of(0.9 * kCarry * kDepth, kDepth), 2);
    EXPECT_EQ(turns_of(1.1 * kCarry * kDepth, kDepth), 1);
    EXPECT_EQ(turns_of(1.1 * kFarthestCarried, 1e-2), 1);
    EXPECT_EQ(turns_of(2e-9, -2e-9), 0) << "nobody pushes";
}

TEST_F(ContactPushes, LeaveWhatIsHeldAndWhatIsApart)
{
    fixed_[0] = 1;
    x_[0].y() = -1e-3;
    const std::vector<Vec3> before = x_;
    const std::vector<ContactTerm> terms{on_plane(0), on_plane(1), between(0.5)};
    EXPECT_FALSE(turns_.sweep(terms, PushOut{rules(), 0.0, x_}, 4));
    EXPECT_EQ(x_, before);
}

TEST_F(ContactPushes, GoNoFartherInASweepThanTrianglesBear)
{
    x_[0].y() = -1.0;
    const std::vector<ContactTerm> terms{on_plane(0)};
    turns_.sweep(terms, PushOut{rules(), 0.0, x_}, 1);
    EXPECT_NEAR(x_[0].y(), -1.0 + rules().clearance_of(terms[0].pair), 1e-12);
    EXPECT_LT(rules().clearance_of(terms[0].pair), altitude_[0]);
}

TEST_F(ContactPushes, StopWhatGoesIntoASurface)
{
    x_[0].y() = -1e-3;
    v_[0] = Vec3(3.0, -2.0, 0.0);
    v_[1] = Vec3(0.0, -2.0, 0.0);
    const std::vector<ContactTerm> terms{on_plane(0), on_plane(1)};
    turns_.sweep(terms, StopAtSurface{rules(), x_, v_}, 1);
    EXPECT_EQ(v_[0], Vec3(3.0, 0.0, 0.0));
    EXPECT_EQ(v_[1], Vec3(0.0, -2.0, 0.0)) << "above it";
}

TEST_F(ContactPushes, RubByCoulombsLaw)
{
    constexpr double kDepth = 1e-3;
    x_[0] = Vec3(0.01, -kDepth, 0.0);
    v_[0] = Vec3(4.0, -2.0, 0.0);
    const std::vector<ContactTerm> terms{on_plane(0)};
    turns_.sweep(terms, Rub{rules(), x_, v_}, 1);
    EXPECT_NEAR(x_[0].x(), 0.01 - kFriction * kDepth, 1e-12);
    EXPECT_NEAR(x_[0].y(), 0.0, 1e-12);
    EXPECT_NEAR(v_[0].x(), 4.0 - kFriction * 2.0, 1e-12);
    EXPECT_NEAR(v_[0].y(), 0.0, 1e-12);
}

} // namespace
} // namespace toile
