#include "scenes/method/step_control.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes/format/read_scene.h"
#include "scenes/method/solver_choice.h"
#include "scenes/world/world.h"

namespace toile::test {

using namespace scenes;

namespace {

const auto kStill = [](int) { return 0.0; };

StepReport with_error(double error)
{
    StepReport report;
    report.step_error = error;
    return report;
}

Scene scene_of(const std::string& keys) { return parse_scene("{\"toile\": 1, " + keys + "}", "test.json"); }

const std::string kSheet =
    R"("cloths": [{"name": "sheet", "rectangle": {"size": [0.4, 0.2], "resolution": 0.02}}])";

/// Lengths [ticks] of the steps of a sample, each with the same error [m].
std::vector<int> steps_of_sample(StepControl& control, double error)
{
    std::vector<int> lengths;
    for (int begin = 0; begin < control.ticks_of_sample(); begin += lengths.back()) {
        lengths.push_back(control.choose(begin, kStill));
        control.observe(with_error(error));
    }
    return lengths;
}

} // namespace

TEST(StepControl, DividesASampleEvenlyWhereAsked)
{
    StepControl control = StepControl::fixed(1.0 / 30.0, 3);
    EXPECT_EQ(steps_of_sample(control, 1.0), (std::vector<int>{1, 1, 1}));
    EXPECT_DOUBLE_EQ(control.tick(), 1.0 / 90.0);
}

TEST(StepControl, LengthensStepsOfLittleError)
{
    StepControl control = StepControl::by_motion(1.0 / 30.0, 1e-4);
    EXPECT_EQ(control.ticks_of_sample(), 2 * StepControl::kTicksOfLongest);
    EXPECT_DOUBLE_EQ(control.tick() * StepControl::kTicksOfLongest, StepControl::kLongest);
    EXPECT_EQ(steps_of_sample(control, 1e-6), (std::vector<int>{16, 16, 32, 64}));
    EXPECT_EQ(steps_of_sample(control, 1e-6), (std::vector<int>{64, 64}));
}

TEST(StepControl, HalvesStepsOfTooMuchErrorAtOnce)
{
    StepControl control = StepControl::by_motion(1.0 / 60.0, 1e-4);
    EXPECT_EQ(steps_of_sample(control, 2e-4), (std::vector<int>{16, 8, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4}));
    EXPECT_EQ(steps_of_sample(control, 5e-5), std::vector<int>(16, 4)) << "neither too much nor little";
}

TEST(StepControl, TakesStepsOfATickWhereTheErrorIsGross)
{
    StepControl control = StepControl::by_motion(1.0 / 60.0, 1e-4);
    std::vector<int> lengths = steps_of_sample(control, 2e-3);
    lengths.resize(6);
    EXPECT_EQ(lengths, (std::vector<int>{16, 8, 4, 2, 1, 1}));
    EXPECT_EQ(steps_of_sample(control, 2e-4), std::vector<int>(64, 1)) << "still too much";
    lengths = steps_of_sample(control, 1e-6);
    lengths.resize(5);
    EXPECT_EQ(lengths, (std::vector<int>{1, 1, 2, 4, 8}));
}

TEST(StepControl, RefusesGrossErrorsOfStepsThatAreNotShortYet)
{
    StepControl control = StepControl::by_motion(1.0 / 60.0, 1e-4);
    EXPECT_EQ(control.choose(0, kStill), 16);
    EXPECT_DOUBLE_EQ(control.max_error(), 1e-3);
    StepReport refused = with_error(2e-3);
    refused.refused = 1;
    control.observe(refused);
    EXPECT_EQ(control.choose(0, kStill), 8);
    control.observe(refused);
    EXPECT_EQ(control.choose(0, kStill), 4);
    EXPECT_EQ(control.max_error(), kAnyStepError);
    StepControl fixed = StepControl::fixed(1.0 / 30.0, 3);
    fixed.choose(0, kStill);
    EXPECT_EQ(fixed.max_error(), kAnyStepError);
}

TEST(StepControl, NoStepIsLongerThanASixtiethOfASecond)
{
    for (const double fps : {12.0, 24.0, 25.0, 30.0, 60.0, 120.0}) {
        const StepControl control = StepControl::by_motion(1.0 / fps, 1e-4);
        EXPECT_LE(control.longest() * control.tick(), StepControl::kLongest * (1.0 + 1e-12)) << fps;
        EXPECT_NEAR(control.ticks_of_sample() * control.tick(), 1.0 / fps, 1e-15) << fps;
    }
}

TEST(StepControl, ShortensStepsWhereBodiesAreFast)
{
    StepControl control = StepControl::by_motion(1.0 / 60.0, 1e-4);
    control.choose(0, kStill);
    control.observe(with_error(0.0));
    EXPECT_EQ(control.choose(32, [](int ticks) { return 0.07 * ticks; }), 8);
    control.observe(with_error(5e-5));
    EXPECT_EQ(control.choose(40, kStill), 8) << "begins at a multiple of its length";
    EXPECT_EQ(control.choose(48, kStill), 16);
}

TEST(StepControl, IsChosenByTheScene)
{
    const auto substeps = [](const std::string& keys) {
        return step_method_of(scene_of(R"("frames": 2, )" + keys + kSheet)).substeps;
    };
    EXPECT_EQ(substeps(""), 0) << "by what moves";
    EXPECT_EQ(substeps(R"("solver": {"substeps": 3}, )"), 3);
    EXPECT_EQ(substeps(R"("solver": {"quality": "preview"}, )"), 4);
    EXPECT_EQ(substeps(R"("solver": {"outer": "lbfgs"}, )"), 4);
    EXPECT_EQ(substeps(R"("solver": {"method": "direct"}, )"), 4);
    EXPECT_EQ(substeps(R"("solids": [{"name": "ball", "sphere": {"radius": 0.1}}], )"), 4);
}

TEST(StepControl, FreeFallTakesTheLongestSteps)
{
    World world(scene_of(R"("frames": 10, "air": {"density": 0}, )" + kSheet));
    EXPECT_GT(world.advance_frame().steps, 2) << "the first step is of first order";
    world.advance_frame();
    const StepReport report = world.advance_frame();
    EXPECT_EQ(report.steps, 2);
    EXPECT_EQ(report.refused, 0);
    EXPECT_EQ(world.stages().calls("linear/factor"), 0) << "no global solver";
}

TEST(StepControl, ClothFollowsAFastBody)
{
    // 0.5 m in 0.1 s: ten centimetres in the longest step.
    World world(scene_of(R"("frames": 7, "avatars": [{"name": "ball", "sphere": {"radius": 0.05},
        "translate": [0, -0.3, 0], "keyframes": [{"time": 0.05}, {"time": 0.15, "translate": [0, 0.5, 0]}]}], )" +
                         kSheet));
    std::vector<int> steps;
    while (world.frame() + 1 < world.frame_count())
        steps.push_back(world.advance_frame().steps);
    EXPECT_GE(*std::max_element(steps.begin(), steps.end()), 5);
    const View<const Vec3> x = world.cloths()[0].positions;
    double highest = -1.0;
    for (const Vec3& p : x)
        highest = std::max(highest, p.y());
    EXPECT_GT(highest, 0.2) << "the ball's top has risen to 0.25 m and carries the sheet";
}

/// The error that a step reports is the error it makes: x = sin(w t) against one more step.
TEST(StepControl, EstimatesTheErrorOfAStep)
{
    for (const double ratio : {0.5, 1.0, 2.0}) {
        const double h = 0.01, w = 3.0, t = 0.2;
        const Bdf2 scheme = Bdf2::of_ratio(h, ratio);
        const auto at = [&](double time) { return Vec3(std::sin(w * time), 0.0, 0.0); };
        const auto v_at = [&](double time) { return Vec3(w * std::cos(w * time), 0.0, 0.0); };
        // One step of the linear oscillator a = -w^2 x from exact values.
        const double previous = t - h / ratio, step = scheme.implicit_step();
        const Vec3 y = scheme.a0 * at(t) - scheme.a1 * at(previous) +
                       step * (scheme.a0 * v_at(t) - scheme.a1 * v_at(previous));
        const Vec3 x = y / (1.0 + step * step * w * w);
        const double error = (x - at(t + h)).norm();
        const double estimate = scheme.error_of(x, at(t), v_at(t), v_at(previous)).norm();
        EXPECT_NEAR(estimate, error, 0.1 * error) << "ratio " << ratio;
    }
}

} // namespace toile::test
