#include "core/pd/newton/newton.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace toile::test {

namespace {

constexpr double kDt = 0.01, kTolerance = 0.1;

/// One point of unit mass and stiffness at a spring: E(x) = x^2 / 2. Directions are those of a Hessian that
/// is too stiff, as one that is projected.
class SpringSpace : public NewtonSpace {
public:
    /// @param hessian  [-] over the true one
    /// @param error    [m/s] of directions, as they say
    SpringSpace(double hessian, double error) : hessian_(hessian), error_(error) {}

    double x = 1.0; ///< [m]

    double evaluate() override { return value(x); }
    double max_speed() override { return std::numeric_limits<double>::infinity(); }
    Solution find_direction(bool, double) override
    {
        direction_ = -x / hessian_;
        return {1, true, error_, 0.0, 0.0};
    }
    bool has_contact() override { return false; }
    double model(double) override { return 0.0; }
    Solution correct(double) override { return {}; }
    Trial try_step(double length) override
    {
        trial_ = x + length * direction_;
        return {value(trial_), x * direction_, trial_ * direction_, std::fabs(direction_) / kDt,
                std::fabs(direction_)};
    }
    double try_rest(double) override { return std::numeric_limits<double>::infinity(); }
    double try_local_global() override { return 0.0; }
    void take() override
    {
        before_ = x;
        x = trial_;
    }
    void retake(double length) override { x = trial_ = before_ + length * direction_; }
    void keep() override { kept_ = x; }
    void restore() override { x = kept_; }
    bool has_moved() override { return x != trial_; }
    double driving_speed() override { return 1.0; }
    bool are_fixed_moving() override { return true; }
    double gradient_norm() override { return std::fabs(x); }

private:
    static double value(double at) { return 0.5 * at * at; }

    double hessian_, error_;
    double direction_ = 0.0, trial_ = 0.0, before_ = 0.0, kept_ = 0.0;
};

/// SpringSpace with contact that never is as a direction sees it: its model falls by a hundredth of what each
/// correction promises.
class ChatteringSpace : public SpringSpace {
public:
    /// @param size  [m/s] of directions and corrections
    explicit ChatteringSpace(double size) : SpringSpace(1.0, 0.0), size_(size) {}

    int corrections = 0;

    Solution find_direction(bool is_first, double error) override
    {
        Solution found = SpringSpace::find_direction(is_first, error);
        found.size = size_;
        found.decrease = 1.0;
        return found;
    }
    bool has_contact() override { return true; }
    double model(double length) override { return value_ - 0.01 * length; }
    Solution correct(double) override
    {
        ++corrections;
        value_ -= 0.01;
        return {1, true, 0.0, size_, 1.0};
    }

private:
    double size_, value_ = 0.0;
};

OuterLoop::Outcome minimise(SpringSpace& space)
{
    return Newton::minimise(space, {kTolerance, 200, kDt, false}, {}, true);
}

TEST(Newton, EndsAtOnceWhereTheHessianIsTrue)
{
    SpringSpace space(1.0, 0.0);
    const OuterLoop::Outcome outcome = minimise(space);
    EXPECT_TRUE(outcome.converged);
    EXPECT_EQ(outcome.iterations, 2);
    EXPECT_EQ(space.x, 0.0);
}

/// Each step goes a twentieth of the way, so that the minimum is 20 times farther than a step says.
TEST(Newton, IsNearTheMinimumAlthoughTheHessianIsTooStiff)
{
    SpringSpace space(20.0, 0.0);
    EXPECT_TRUE(minimise(space).converged);
    EXPECT_LE(std::fabs(space.x), kTolerance * kDt);
}

TEST(Newton, DoesNotConvergeByDirectionsOfLargeError)
{
    SpringSpace space(1.0, 1.1 * kTolerance);
    EXPECT_FALSE(minimise(space).converged);
}

TEST(Newton, CorrectsNoDirectionsSmallerThanTheirError)
{
    ChatteringSpace space(0.1 * kTolerance);
    EXPECT_TRUE(minimise(space).converged);
    EXPECT_EQ(space.corrections, 0);
}

TEST(Newton, DoesNotConvergeByDirectionsThatContactKeepsCorrecting)
{
    ChatteringSpace space(kTolerance);
    EXPECT_FALSE(minimise(space).converged);
    EXPECT_GT(space.corrections, 0);
}

/// Where each look finds other pairs, small steps in succession converge, and a look that asks for more goes
/// on.
TEST(Newton, SettlesAlthoughEachLookFindsOtherPairs)
{
    SpringSpace space(1.0, 0.0);
    std::vector<MinimiserProgress> looks;
    int more = 2;
    const auto look = [&](MinimiserProgress progress) {
        looks.push_back(progress);
        return progress != MinimiserProgress::kSettled || more-- > 0;
    };
    const OuterLoop::Outcome outcome = Newton::minimise(space, {kTolerance, 200, kDt, false}, look, false);
    EXPECT_TRUE(outcome.converged);
    ASSERT_EQ(looks.size(), 7u); // a long step, three small ones, and three that have settled
    EXPECT_EQ(looks[0], MinimiserProgress::kFar);
    EXPECT_EQ(looks[3], MinimiserProgress::kConverged);
    EXPECT_EQ(looks[4], MinimiserProgress::kSettled);
}

/// A step longer than 0.2 m is moved back, twice as far as it had gone to the other side of its start.
TEST(Newton, TakesStepsAgainThatContactMovesBackToHigherValues)
{
    SpringSpace space(1.0, 0.0);
    double last = space.x, highest = 0.0;
    int looks = 0;
    const auto look = [&](MinimiserProgress) {
        ++looks;
        const bool is_long = std::fabs(space.x - last) > 0.2;
        if (is_long)
            space.x = last + 2.0 * std::fabs(space.x - last);
        else {
            last = space.x;
            highest = std::max(highest, space.x);
        }
        return is_long;
    };
    const OuterLoop::Outcome outcome = Newton::minimise(space, {kTolerance, 200, kDt, false}, look, false);
    EXPECT_TRUE(outcome.converged);
    EXPECT_LE(std::fabs(space.x), kTolerance * kDt);
    EXPECT_LT(highest, 1.0);
    EXPECT_GT(looks, outcome.iterations);
    EXPECT_LT(looks, 30);
}

/// Contact moves back what the last iteration that is allowed gives.
TEST(Newton, EndsUnfinishedAtTheLowestPoint)
{
    constexpr int kIterations = 10;
    SpringSpace space(20.0, 0.0);
    double lowest = space.x;
    int looks = 0;
    const auto look = [&](MinimiserProgress) {
        if (++looks < kIterations)
            lowest = space.x;
        else
            space.x = 0.95;
        return false;
    };
    const OuterLoop::Outcome outcome =
        Newton::minimise(space, {kTolerance, kIterations, kDt, false}, look, false);
    EXPECT_FALSE(outcome.converged);
    EXPECT_LT(lowest, 0.7);
    EXPECT_EQ(space.x, lowest);
    EXPECT_EQ(outcome.value, 0.5 * lowest * lowest);
}

} // namespace

} // namespace toile::test
