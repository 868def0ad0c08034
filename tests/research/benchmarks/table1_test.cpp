#include "research/benchmarks/paper/table1.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace toile::research::paper {
namespace {

/// Measures scenes a, b and c. b has too little memory for its first row, and c does not work.
class Table1 : public ::testing::Test {
protected:
    bool measure(int max_rows = 100)
    {
        TableCalls calls;
        calls.measure = [&](const std::filesystem::path& scene, TableMethod method) {
            const std::string name = scene.stem().string();
            static const char* const kNames[] = {" converged", " error", " move", " jacobi"};
            asked_.push_back(name + kNames[int(method)]);
            if (asked_.back() == "b error")
                throw DeviceError("CUDA device 0 is out of memory: 'pairs' asked for 72 GB");
            if (scene == "c.json")
                throw InvalidInput("c.json: can't be opened");
            TableRow row{name, asked_.back(), {}};
            row.run.sample = {Vec3(0, 0, method == TableMethod::ToTheError ? 0.003 : 0), Vec3::Zero()};
            return row;
        };
        calls.finished = [&](const std::vector<TableRow>& rows) {
            ++finished_;
            errors_of_rows_.push_back(rows.back().error);
            printed_ += markdown_of(rows.back());
            csv_ = csv_of(rows);
        };
        calls.failed = [&](const std::string& error) { errors_.push_back(error); };
        calls.goes_on = [&] { return int(asked_.size()) < max_rows; };
        return measure_table1({"a.json", "b.json", "c.json", "d.json"}, calls);
    }

    std::vector<std::string> asked_, errors_;
    std::vector<double> errors_of_rows_;
    int finished_ = 0;
    std::string printed_, csv_;
};

TEST_F(Table1, KeepsFinishedRowsWhereOthersFail)
{
    EXPECT_FALSE(measure());
    EXPECT_EQ(asked_, (std::vector<std::string>{"a converged", "a error", "a move", "a jacobi", "b converged",
                                                "b error", "b move", "b jacobi", "c converged", "d converged",
                                                "d error", "d move", "d jacobi"}));
    EXPECT_EQ(errors_, (std::vector<std::string>{
                           "b.json, to the error: CUDA device 0 is out of memory: 'pairs' asked for 72 GB",
                           "c.json: can't be opened"}));
    EXPECT_EQ(finished_, 8);
    EXPECT_EQ(std::count(csv_.begin(), csv_.end(), '\n'), 1 + 8);
    EXPECT_NE(csv_.find("\nb,b move,"), std::string::npos) << csv_;
    ASSERT_EQ(errors_of_rows_.size(), 8u);
    EXPECT_NEAR(errors_of_rows_[0], 0.003 / std::sqrt(2.0), 1e-12); // RMS of two vertices
    EXPECT_EQ(errors_of_rows_[1], 0.0);
    EXPECT_EQ(std::count(printed_.begin(), printed_.end(), '\n'), 8);
}

TEST_F(Table1, EndsBeforeTheNextRow)
{
    EXPECT_FALSE(measure(6));
    EXPECT_EQ(asked_.back(), "b error");
    EXPECT_EQ(finished_, 3);
}

TEST_F(Table1, PrintsRowsBelowItsHeader)
{
    const std::string header = markdown_header(), row = markdown_of(TableRow{"letters", "by move", {}});
    EXPECT_EQ(std::count(header.begin(), header.end(), '\n'), 2);
    EXPECT_EQ(std::count(row.begin(), row.end(), '|'), std::count(header.begin(), header.end(), '|') / 2);
}

} // namespace
} // namespace toile::research::paper
