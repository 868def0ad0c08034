#include <gtest/gtest.h>

#include <set>

#include "research/benchmarks/accuracy/exact.h"
#include "research/benchmarks/accuracy/run.h"
#include "tests/support/temporary_folder.h"

namespace toile::research::accuracy {
namespace {

TEST(ExactAccuracy, HasTheHeavyElasticaOfTheLiterature)
{
    // [Romero et al. 2021], by collocation and by shooting from the free end.
    const std::pair<double, double> kDropOverReach[] = {{0.1, 0.012500}, {1.0, 0.12456},  {5.0, 0.58572},
                                                        {10.0, 1.06680}, {50.0, 3.70556}, {100.0, 5.88811}};
    for (const auto& [load, right] : kDropOverReach)
        EXPECT_NEAR(heavy_elastica(load), right, 1e-5 * (1.0 + right)) << load;
}

TEST(ExactAccuracy, HasTheCatenary)
{
    EXPECT_NEAR(catenary_sag(0.5), 0.39819, 1e-5);
    EXPECT_NEAR(catenary_sag(0.7), 0.31972, 1e-5);
    EXPECT_NEAR(catenary_sag(0.9), 0.19071, 1e-5);
}

TEST(ExactAccuracy, HasTheLoadThatBucklesAStripEdgeOn)
{
    // A load of 12.854 [Timoshenko & Gere 1961, section 6.3]: the twist changes its sign through infinity.
    EXPECT_LT(lateral_twist(12.85, 0.0), -1e3);
    EXPECT_GT(lateral_twist(12.86, 0.0), 1e3);
    // Small loads: the moment of the weight along the strip, twisted by the tilt.
    EXPECT_NEAR(lateral_twist(0.1, 0.0), -0.01 / 4.0 / 30.0, 1e-7);
}

/// Cases without a converged run take seconds; they hold at default settings. Only whether dropped
/// cloth has come to rest is left to chance today (docs/performance.md).
TEST(Accuracy, HoldsWhereTheAnswerIsExact)
{
    int count = 0;
    for (const Case& trial : make_cases(test::process_folder(), true)) {
        if (trial.reference || trial.name.starts_with("cotton square dropped on a "))
            continue;
        SCOPED_TRACE(trial.name);
        const Result result = run(trial, {}, [] { return true; });
        EXPECT_TRUE(result.holds) << result.value << " for " << result.right;
        EXPECT_EQ(result.from, "exact");
        ++count;
    }
    EXPECT_GE(count, 7);
}

TEST(Accuracy, MeasuresAgainstAConvergedRun)
{
    for (Case& trial : make_cases(test::process_folder(), true))
        if (trial.reference) {
            EXPECT_EQ(frames_of(trial), 2 * (trial.scene.frames - 1));
            trial.reference->solver.substeps = trial.scene.solver.substeps;
            trial.reference->solver.velocity_tolerance = 0.01;
            const Result result = run(trial, {}, [] { return true; });
            EXPECT_EQ(result.from, "converged");
            EXPECT_LT(result.error, 3.0) << "nearly the same run twice";
            return;
        }
    FAIL() << "no case has a converged run";
}

TEST(Accuracy, QuotesNamesWithCommas)
{
    Result result;
    result.name = "sheet, 0.2 s";
    EXPECT_NE(csv_table({result}).find("\n\"sheet, 0.2 s\",,"), std::string::npos) << csv_table({result});
}

TEST(Accuracy, EndsWhenAsked)
{
    int frames = 0;
    const Result result = run(make_cases(test::process_folder(), true)[0], {}, [&] { return ++frames < 3; });
    EXPECT_EQ(frames, 3);
    EXPECT_FALSE(result.holds);
}

TEST(Accuracy, NamesEveryCaseOnce)
{
    std::set<std::string> names;
    for (const Case& trial : make_cases(test::process_folder(), false))
        EXPECT_TRUE(names.insert(trial.name).second) << trial.name;
    EXPECT_GE(names.size(), 16u);
}

} // namespace
} // namespace toile::research::accuracy
