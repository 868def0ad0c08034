#include "collision/contact/projections.h"

#include <gtest/gtest.h>

#include <numeric>

#include "collision/contact/cpu/gauss_seidel.h"

namespace toile::test {

using namespace collision;

namespace {

constexpr double kStiffness = 1e3, kMass = 0.02, kDt = 0.01, kFriction = 0.3;

/// Two vertices, the second above the first, over the plane y = 0.
class ContactProjections : public testing::Test {
protected:
    ProjectionRules rules() const { return {fixed_, rigid_, masses_, altitude_, kDt, 1.0}; }

    /// Term of a vertex and the plane.
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
    /// Term of the second vertex and the first, which keep that distance.
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
    CpuGaussSeidel gauss_seidel_;
};

TEST_F(ContactProjections, ReachAndKeepTheEquilibriumOfTheSpring)
{
    constexpr double kReach = 2e-3, kMobility = kDt * kDt / kMass;
    constexpr double kDepth = kReach / (1.0 + kStiffness * kMobility);
    x_[0].y() = -kReach;
    std::vector<double> force(1, 0.0);
    const std::vector<ContactTerm> terms{on_plane(0)};
    EXPECT_TRUE(gauss_seidel_.sweep(terms, ProjectCompliant{rules(), force, x_}, 1));
    EXPECT_NEAR(x_[0].y(), -kDepth, 1e-15);
    EXPECT_NEAR(force[0], kStiffness * kDepth, 1e-12);
    const std::vector<Vec3> rest = x_;
    gauss_seidel_.sweep(terms, ProjectCompliant{rules(), force, x_}, 3);
    EXPECT_NEAR(x_[0].y(), rest[0].y(), 1e-12);
}

TEST_F(ContactProjections, NeverPull)
{
    x_[0].y() = -2e-3;
    std::vector<double> force(1, 0.0);
    const std::vector<ContactTerm> terms{on_plane(0)};
    gauss_seidel_.sweep(terms, ProjectCompliant{rules(), force, x_}, 1);
    x_[0].y() += 5e-3; // moved out by other projections
    gauss_seidel_.sweep(terms, ProjectCompliant{rules(), force, x_}, 1);
    EXPECT_EQ(force[0], 0.0);
    EXPECT_NEAR(x_[0].y(), 3e-3, 1e-12) << "as if it had not acted";
}

TEST_F(ContactProjections, IncludeTermsActivatedWithinASweep)
{
    constexpr double kDistance = 3e-3, kDepth = 4e-4, kApart = 3e-4;
    const std::vector<ContactTerm> terms{on_plane(0), between(kDistance)};
    x_[0].y() = -kDepth;
    x_[1].y() = x_[0].y() + kDistance + kApart;
    const double before = x_[1].y();
    EXPECT_TRUE(gauss_seidel_.sweep(terms, ProjectNormal{rules(), 0.0, x_}, 1));
    EXPECT_NEAR(x_[1].y() - before, 0.5 * (kDepth - kApart), 1e-12);
    EXPECT_NEAR(x_[1].y() - x_[0].y(), kDistance, 1e-12);
}

TEST_F(ContactProjections, AreScheduledOnlyNearActiveTerms)
{
    constexpr double kDepth = 1e-4;
    const auto scheduled_count = [&](double apart, double depth) {
        const std::vector<ContactTerm> terms{on_plane(0), between(0.5)};
        x_ = {Vec3(0.0, -depth, 0.0), Vec3(0.0, -depth + 0.5 + apart, 0.0)};
        const ProjectNormal projection{rules(), 0.0, x_};
        std::vector<float> deepest(2, 0.0F);
        std::vector<unsigned char> flags(GaussSeidelSchedule{2}.slot_count());
        for (int i = 0; i < 2; ++i)
            FindDeepest<ProjectNormal>{projection, terms, deepest}(i);
        for (int i = 0; i < 2; ++i)
            FlagActive<ProjectNormal>{projection, terms, GaussSeidelSchedule{2}, deepest, flags}(i);
        return std::accumulate(flags.begin(), flags.end(), 0);
    };
    EXPECT_EQ(scheduled_count(0.9 * kPropagationFactor * kDepth, kDepth), 2);
    EXPECT_EQ(scheduled_count(1.1 * kPropagationFactor * kDepth, kDepth), 1);
    EXPECT_EQ(scheduled_count(1.1 * kMaxPropagation, 1e-2), 1);
    EXPECT_EQ(scheduled_count(2e-9, -2e-9), 0) << "none is active";
}

TEST_F(ContactProjections, LeaveFixedAndSeparatedVerticesUnchanged)
{
    fixed_[0] = 1;
    x_[0].y() = -1e-3;
    const std::vector<Vec3> before = x_;
    const std::vector<ContactTerm> terms{on_plane(0), on_plane(1), between(0.5)};
    EXPECT_FALSE(gauss_seidel_.sweep(terms, ProjectNormal{rules(), 0.0, x_}, 4));
    EXPECT_EQ(x_, before);
}

TEST_F(ContactProjections, AreLimitedByTheTriangleAltitudePerSweep)
{
    x_[0].y() = -1.0;
    const std::vector<ContactTerm> terms{on_plane(0)};
    gauss_seidel_.sweep(terms, ProjectNormal{rules(), 0.0, x_}, 1);
    EXPECT_NEAR(x_[0].y(), -1.0 + rules().clearance_of(terms[0].pair), 1e-12);
    EXPECT_LT(rules().clearance_of(terms[0].pair), altitude_[0]);
}

TEST_F(ContactProjections, RemoveVelocityIntoASurface)
{
    x_[0].y() = -1e-3;
    v_[0] = Vec3(3.0, -2.0, 0.0);
    v_[1] = Vec3(0.0, -2.0, 0.0);
    const std::vector<ContactTerm> terms{on_plane(0), on_plane(1)};
    gauss_seidel_.sweep(terms, StopAtSurface{rules(), x_, v_}, 1);
    EXPECT_EQ(v_[0], Vec3(3.0, 0.0, 0.0));
    EXPECT_EQ(v_[1], Vec3(0.0, -2.0, 0.0)) << "above it";
}

TEST_F(ContactProjections, ObeyCoulombsLaw)
{
    constexpr double kDepth = 1e-3;
    x_[0] = Vec3(0.01, -kDepth, 0.0);
    v_[0] = Vec3(4.0, -2.0, 0.0);
    const std::vector<ContactTerm> terms{on_plane(0)};
    gauss_seidel_.sweep(terms, ProjectFriction{rules(), x_, v_}, 1);
    EXPECT_NEAR(x_[0].x(), 0.01 - kFriction * kDepth, 1e-12);
    EXPECT_NEAR(x_[0].y(), 0.0, 1e-12);
    EXPECT_NEAR(v_[0].x(), 4.0 - kFriction * 2.0, 1e-12);
    EXPECT_NEAR(v_[0].y(), 0.0, 1e-12);
}

} // namespace
} // namespace toile::test
