#include "garment/seam/tacks.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/garment/gradient_check.h"
#include "tests/garment/hessian_check.h"

namespace toile::test {

using garment::Sewing;
using garment::Tacks;

namespace {

constexpr double kBound = Tacks::kMaxForce / Tacks::kStiffness; // [m] of stretch

std::vector<Vec3> apart(double distance)
{
    const Vec3 a(0.2, 1.1, -0.4), along = Vec3(1.0, -2.0, 0.5).normalized();
    return {a, a + distance * along};
}

/// One thread of free length 3 cm.
std::shared_ptr<Sewing> long_thread()
{
    auto thread = std::make_shared<Sewing>(std::vector<Sewing::Thread>{{0, 1}},
                                           Sewing::Settings{Tacks::kStiffness, Tacks::kMaxForce});
    thread->set_length(0, 0.03);
    return thread;
}

} // namespace

TEST(ThreadsWithLength, PullBeyondTheirLengthAndDoNotPush)
{
    EXPECT_EQ(value_of(*long_thread(), apart(0.01)), 0.0);
    EXPECT_NEAR(value_of(*long_thread(), apart(0.04)), 0.5 * Tacks::kStiffness * 0.01 * 0.01, 1e-12);
    EXPECT_NEAR(value_of(*long_thread(), apart(0.5)), Tacks::kMaxForce * (0.47 - 0.5 * kBound), 1e-12);
    for (const double distance : {0.02, 0.04, 0.5}) {
        const std::vector<Vec3> x = apart(distance);
        std::vector<Vec3> gradient(2, Vec3::Zero());
        long_thread()->add_gradient(x, gradient);
        const double tension = std::min(Tacks::kMaxForce, Tacks::kStiffness * std::max(0.0, distance - 0.03));
        EXPECT_NEAR(gradient[1].dot((x[1] - x[0]).normalized()), tension, 1e-10);
        EXPECT_LT((gradient[0] + gradient[1]).norm(), 1e-12);
    }
}

TEST(ThreadsWithLength, HaveTheDerivativesOfTheirValue)
{
    EXPECT_EQ(dense_hessian(long_thread(), apart(0.02), Definiteness::Exact).cwiseAbs().maxCoeff(), 0.0);
    for (const double distance : {0.04, 0.5}) {
        expect_gradient_of_value(*long_thread(), apart(distance));
        expect_exact(long_thread(), apart(distance));
        expect_semidefinite(long_thread(), apart(distance));
    }
}

TEST(Tacks, ShortenFromTheGapOfTheirTimeOn)
{
    Tacks tacks({{0, 1, 0.5}});
    tacks.begin_step(0.4, apart(0.3));
    EXPECT_TRUE(std::isinf(tacks.threads()->length(0)));
    EXPECT_EQ(value_of(*tacks.threads(), apart(0.3)), 0.0) << "it hangs loose";
    EXPECT_FALSE(tacks.are_closing(0.4));
    EXPECT_TRUE(tacks.are_closing(0.5));

    tacks.begin_step(0.5, apart(0.1));
    EXPECT_NEAR(tacks.threads()->length(0), 0.1, 1e-15);
    tacks.begin_step(0.7, apart(0.09));
    EXPECT_NEAR(tacks.threads()->length(0), 0.1 - 0.2 * Tacks::kSpeed, 1e-15);
    EXPECT_TRUE(tacks.are_closing(0.7));
    tacks.begin_step(1.1, apart(0.0));
    EXPECT_EQ(tacks.threads()->length(0), 0.0);
    EXPECT_FALSE(tacks.are_closing(1.1));
}

TEST(Tacks, CloseWhileTheSceneSettlesUnlessTheyHaveATime)
{
    Tacks tacks({{0, 1, 0.0}, {0, 1, 0.1}});
    tacks.begin_step(-1.0, apart(0.02));
    EXPECT_NEAR(tacks.threads()->length(0), 0.02, 1e-15);
    EXPECT_TRUE(std::isinf(tacks.threads()->length(1)));
}

} // namespace toile::test
