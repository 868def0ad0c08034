#include <gtest/gtest.h>

#include <algorithm>

#include "research/benchmarks/sheet/table.h"

namespace toile::research::sheet {
namespace {

bool go_on(int) { return true; }

/// Runs the quick sheet at some settings of the ladder, by name.
std::vector<Result> run_quick(const std::vector<std::string>& names)
{
    std::vector<Result> results;
    for (const Setting& setting : ladder())
        if (std::find(names.begin(), names.end(), setting.name) != names.end())
            results.push_back(run(quick_sheet(), setting, go_on));
    compare(quick_sheet(), results);
    return results;
}

TEST(Sheet, ErrorsFallWithIterations)
{
    const std::vector<Result> results = run_quick(
        {"reference", "second reference", "3 iterations", "8 iterations", "20 iterations", "50 iterations"});
    ASSERT_EQ(results.size(), 6u);
    for (const double error : results[0].errors)
        EXPECT_EQ(error, 0.0) << "of the reference to itself";
    for (size_t k = 0; k < quick_sheet().compared.size(); ++k) {
        SCOPED_TRACE(quick_sheet().compared[k]);
        EXPECT_LT(results[1].errors[k], 1e-2) << "of converged runs to each other";
        for (size_t i = 3; i < results.size(); ++i)
            EXPECT_LT(results[i].errors[k], results[i - 1].errors[k]) << results[i].setting.name;
    }
}

TEST(Sheet, HangsByItsCornersWithAndWithoutAStrainLimit)
{
    const Sheet sheet = quick_sheet();
    const std::vector<Result> results = run_quick({"tolerance 1e-4 m", "tolerance 1e-4 m with strain limit"});
    ASSERT_EQ(results.size(), 2u);
    for (const Result& result : results) {
        ASSERT_EQ(result.samples.size(), sheet.compared.size());
        const std::vector<Vec3>& end = result.samples.back();
        ASSERT_EQ(int(end.size()), sheet.side * sheet.side);
        EXPECT_EQ(end.front().y(), 0.0);
        EXPECT_EQ(end[sheet.side - 1].y(), 0.0);
        EXPECT_LT(end.back().y(), -0.2);
        EXPECT_TRUE(result.errors.empty()) << "without a reference there is nothing to compare with";
    }
    EXPECT_GT(results[0].max_strain, 0.07);
    EXPECT_LT(results[1].max_strain, 0.07);
}

TEST(Sheet, StopsOnRequest)
{
    const Result result = run(quick_sheet(), ladder().back(), [](int step) { return step < 2; });
    EXPECT_EQ(result.samples.size(), 0u);
    EXPECT_EQ(result.mean_ms, 0.0);
}

TEST(SheetTable, HasTheTimesOfComparisonInItsHeader)
{
    Result result;
    result.setting.name = "8 iterations";
    result.mean_ms = 4.5;
    result.errors = {0.0, 0.25, 1.5};
    EXPECT_EQ(csv_table(full_sheet(), {result}),
              "setting,iterations_per_step,ms_per_step,median_ms_per_step,user_ms_per_step,first_step_ms,"
              "max_strain,error_at_0.25_s_in_edges,error_at_0.5_s_in_edges,error_at_1_s_in_edges\n"
              "8 iterations,0.0,4.50,0.00,0.00,0,0.000,0,0.25,1.5\n");
    const std::string table = markdown_table(full_sheet(), {result});
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 3);
}

} // namespace
} // namespace toile::research::sheet
