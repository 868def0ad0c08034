#include "core/pd/step/take_step.h"

#include <algorithm>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/pd/step/body.h"

namespace toile::test {

namespace {

using testing::ElementsAre;

/// Parts that note their calls; contact and limits note theirs in the same list.
class NotedStep : public StepSpace, public ActiveSetEnergy, public StepProjection {
public:
    std::vector<std::string> calls;
    double value = 1.0;    ///< [J] of every minimisation
    int searches_left = 0; ///< calls of revise() that find something
    int moves_left = 0;    ///< calls of keep_apart() that move cloth

    void begin(const StepInput&) override { calls.push_back("begin"); }
    StepStart start() const override { return {}; }
    StepField end_positions() override { return x_; }
    StepField end_velocities() override { return v_; }
    OuterLoop::Outcome minimise(ActiveSetEnergy*, int, bool is_first) override
    {
        calls.push_back(is_first ? "minimise first" : "minimise");
        OuterLoop::Outcome outcome;
        outcome.converged = true;
        outcome.iterations = 2;
        outcome.value = value;
        return outcome;
    }
    OuterLoop::Outcome minimise_by_newton(const Newton::Settings& settings, const Newton::Revise& revise,
                                          bool is_calm) override
    {
        calls.push_back(is_calm ? "calm newton" : "newton");
        OuterLoop::Outcome outcome;
        outcome.value = value;
        outcome.speed = settings.tolerance;
        outcome.converged = true;
        if (revise)
            revise(MinimiserProgress::kConverged);
        return outcome;
    }
    void restart_touching(const StepInput&) override { calls.push_back("restart touching"); }
    void mark_touching(ActiveSetEnergy&) override { calls.push_back("mark touching"); }
    double local_error() override
    {
        calls.push_back("error");
        return 2e-3;
    }
    void abandon() override { calls.push_back("abandon"); }
    void finish(StepProjection*) override { calls.push_back("finish"); }
    void project(StepProjection&, const std::function<bool()>&) override { calls.push_back("project"); }
    void end(StepProjection*, StepReport&) override { calls.push_back("end"); }

    void begin_step(const StepStart&) override { calls.push_back("find contact"); }
    bool make_feasible(StepField) const override { return true; }
    bool sweep_once(StepField) const override { return false; }
    double add_gradient(View<const Vec3>, View<Vec3>) const override { return 0.0; }
    bool activate(View<const Vec3>) override { return true; }
    void add_hessian_product(View<const Vec3>, View<Vec3>) const override {}
    View<const Mat3> diagonal_blocks() const override { return {}; }
    void append_terms(std::vector<FrozenTerm>&) const override {}
    bool revise(StepField, MinimiserProgress) override
    {
        calls.push_back("revise");
        return searches_left-- > 0;
    }
    void clear(StepField, StepField) override { calls.push_back("clear"); }
    bool keep_apart(StepField, StepField) override
    {
        calls.push_back("keep apart");
        return moves_left-- > 0;
    }
    void end_step(StepField) override { calls.push_back("end contact"); }
    void abandon_step() override { calls.push_back("abandon contact"); }

    void observe(View<const Vec3>) override {}
    void project(View<Vec3>, View<const double>, const std::function<bool()>&) override {}

    StepReport step(bool in_contact, bool is_limited, double max_error = kAnyStepError)
    {
        const std::vector<unsigned char> fixed;
        Newton::Patience patience;
        return take_step(
            *this, {0.1, {}, fixed, {}, in_contact ? this : nullptr, is_limited ? this : nullptr, max_error},
            {50, 3}, patience);
    }

private:
    std::vector<Vec3> x_, v_;
};

TEST(Patience, EndsAfterStepsThatEndUnfinishedButForSomeOfThem)
{
    Newton::Patience patience;
    for (int unfinished = 0; unfinished < 24; ++unfinished) {
        EXPECT_EQ(patience.setbacks(), unfinished < 8 || unfinished == 8 || unfinished == 16 ? 15 : 3)
            << unfinished;
        patience.observe(false);
    }
    patience.observe(true);
    EXPECT_EQ(patience.setbacks(), 15);
}

} // namespace

TEST(TakeStep, AsksForNothingThatTheSceneDoesNotHave)
{
    NotedStep step;
    const StepReport report = step.step(false, false);
    EXPECT_THAT(step.calls, ElementsAre("begin", "minimise first", "finish", "end"));
    EXPECT_EQ(report.status, StepReport::Status::Converged);
    EXPECT_EQ(report.iterations, 2);
}

TEST(TakeStep, MinimisesAgainAfterNewContactAndCorrectsUntilNothingMoves)
{
    NotedStep step;
    step.searches_left = 1;
    step.moves_left = 1;
    const StepReport report = step.step(true, true);
    EXPECT_THAT(step.calls,
                ElementsAre("begin", "find contact", "restart touching", "minimise first", "revise",
                            "minimise", "revise", "mark touching", "finish", "clear", "project", "keep apart",
                            "clear", "project", "keep apart", "end contact", "end"));
    EXPECT_EQ(report.iterations, 4);
}

TEST(TakeStep, LooksForContactInsideOneMinimisationByNewton)
{
    NotedStep step;
    const std::vector<unsigned char> fixed;
    StepLimits limits;
    Newton::Patience patience;
    limits.speed_tolerance = 0.01;
    StepReport report = take_step(step, {0.1, {}, fixed, {}, &step, nullptr}, limits, patience);
    EXPECT_THAT(step.calls,
                ElementsAre("begin", "find contact", "restart touching", "newton", "revise", "mark touching",
                            "finish", "clear", "keep apart", "end contact", "end"));
    EXPECT_EQ(report.speed, 0.01);

    step.calls.clear();
    report = take_step(step, {0.1, {}, fixed, {}, nullptr, nullptr}, limits, patience);
    EXPECT_THAT(step.calls, ElementsAre("begin", "calm newton", "finish", "end"));
    EXPECT_EQ(report.speed, StepLimits::kCalm * 0.01);
}

TEST(TakeStep, BoundsTheNumberOfCorrections)
{
    NotedStep step;
    step.moves_left = 1000;
    step.step(true, false);
    EXPECT_EQ(std::count(step.calls.begin(), step.calls.end(), "keep apart"), kMaxCorrections);
}

TEST(TakeStep, IsAbandonedWhereItsErrorIsTooLarge)
{
    NotedStep step;
    const StepReport report = step.step(true, true, 1e-3);
    EXPECT_THAT(step.calls, ElementsAre("begin", "find contact", "restart touching", "minimise first",
                                        "revise", "mark touching", "error", "abandon", "abandon contact"));
    EXPECT_EQ(report.refused, 1);
    EXPECT_EQ(report.steps, 0);
    EXPECT_EQ(report.iterations, 2);
    EXPECT_EQ(report.step_error, 2e-3);

    step.calls.clear();
    EXPECT_EQ(step.step(false, false, 3e-3).refused, 0);
    EXPECT_THAT(step.calls, ElementsAre("begin", "minimise first", "error", "finish", "end"));
}

/// Contact that holds nothing, and says where asked that vertex 2 touches.
class TouchesAtTwo : public ActiveSetEnergy {
public:
    bool touches = false;
    int abandoned = 0;

    void begin_step(const StepStart&) override {}
    bool may_be_active() const override { return false; }
    bool make_feasible(StepField) const override { return false; }
    bool sweep_once(StepField) const override { return false; }
    double add_gradient(View<const Vec3>, View<Vec3>) const override { return 0.0; }
    bool activate(View<const Vec3>) override { return false; }
    void add_hessian_product(View<const Vec3>, View<Vec3>) const override {}
    View<const Mat3> diagonal_blocks() const override { return {}; }
    void append_terms(std::vector<FrozenTerm>&) const override {}
    void mark_touching(StepField, View<unsigned char> marks) override { marks[2] = touches ? 1 : marks[2]; }
    bool revise(StepField, MinimiserProgress) override { return false; }
    void clear(StepField, StepField) override {}
    bool is_complete() const override { return true; }
    bool keep_apart(StepField, StepField) override { return false; }
    void end_step(StepField) override {}
    void abandon_step() override { ++abandoned; }
};

/// A body that has refused a step goes on as if it had not been tried.
TEST(TakeStep, LeavesNoTraceWhereItIsRefused)
{
    const int n = 3;
    const std::vector<unsigned char> fixed{0, 1, 0};
    const std::vector<Vec3> start(n, Vec3::Zero()), targets(n, Vec3(0.0, 0.1, 0.0));
    const auto moved = [&](bool tries) {
        Body::Settings settings;
        settings.integrator = Integrator::Bdf2;
        settings.outer = OuterMethod::Newton;
        Body body(
            start,
            std::make_unique<System>(std::vector<double>(n, 0.1), std::vector<std::shared_ptr<Energy>>()),
            settings);
        TouchesAtTwo contact;
        const auto step = [&](double dt, double pull) {
            return body.step(dt, std::vector<Vec3>(n, Vec3(0.0, 0.0, pull)), fixed, targets, &contact,
                             nullptr);
        };
        EXPECT_EQ(step(0.01, 1.0).refused, 0);
        EXPECT_EQ(step(0.01, 1.0).refused, 0);
        if (tries) {
            const std::vector<Vec3> x(body.positions().begin(), body.positions().end());
            body.refuse_steps_beyond(1e-6);
            contact.touches = true;
            const StepReport report = step(0.01, 100.0);
            EXPECT_EQ(report.refused, 1);
            EXPECT_EQ(report.steps, 0);
            EXPECT_GT(report.step_error, 1e-6);
            EXPECT_EQ(std::vector<Vec3>(body.positions().begin(), body.positions().end()), x);
            body.refuse_steps_beyond(kAnyStepError);
            contact.touches = false;
            EXPECT_EQ(contact.abandoned, 1);
        }
        EXPECT_EQ(step(0.005, 100.0).refused, 0);
        EXPECT_EQ(step(0.005, 100.0).refused, 0);
        return std::vector<Vec3>(body.positions().begin(), body.positions().end());
    };
    EXPECT_EQ(moved(true), moved(false));
}

TEST(TakeStep, LeavesTheBodyUnchangedIfTheEnergyIsNotFinite)
{
    NotedStep step;
    step.value = std::numeric_limits<double>::quiet_NaN();
    const StepReport report = step.step(true, true);
    EXPECT_EQ(report.status, StepReport::Status::NonFinite);
    EXPECT_FALSE(report.message.empty());
    EXPECT_THAT(step.calls, ElementsAre("begin", "find contact", "restart touching", "minimise first"));
}

} // namespace toile::test
