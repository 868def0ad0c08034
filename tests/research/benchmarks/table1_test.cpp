#include "research/benchmarks/paper/table1.h"

#include <algorithm>

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
            asked_.push_back(scene.stem().string() +
                             (method == TableMethod::ToTheError ? " error" : " move"));
            if (asked_.back() == "b error")
                throw DeviceError("CUDA device 0 is out of memory: 'pairs' asked for 72 GB");
            if (scene == "c.json")
                throw InvalidInput("c.json: can't be opened");
            return TableRow{scene.stem().string(), asked_.back(), {}};
        };
        calls.finished = [&](const std::vector<TableRow>& rows) {
            ++finished_;
            printed_ += markdown_of(rows.back());
            csv_ = csv_of(rows);
        };
        calls.failed = [&](const std::string& error) { errors_.push_back(error); };
        calls.goes_on = [&] { return int(asked_.size()) < max_rows; };
        return measure_table1({"a.json", "b.json", "c.json", "d.json"}, calls);
    }

    std::vector<std::string> asked_, errors_;
    int finished_ = 0;
    std::string printed_, csv_;
};

TEST_F(Table1, KeepsFinishedRowsWhereOthersFail)
{
    EXPECT_FALSE(measure());
    EXPECT_EQ(asked_, (std::vector<std::string>{"a error", "a move", "b error", "b move", "c error",
                                                "d error", "d move"}));
    EXPECT_EQ(errors_, (std::vector<std::string>{
                           "b.json, to the error: CUDA device 0 is out of memory: 'pairs' asked for 72 GB",
                           "c.json: can't be opened"}));
    EXPECT_EQ(finished_, 5);
    EXPECT_EQ(std::count(csv_.begin(), csv_.end(), '\n'), 1 + 5);
    EXPECT_NE(csv_.find("\nb,b move,"), std::string::npos) << csv_;
    EXPECT_EQ(std::count(printed_.begin(), printed_.end(), '\n'), 5);
}

TEST_F(Table1, EndsBeforeTheNextRow)
{
    EXPECT_FALSE(measure(3));
    EXPECT_EQ(asked_.back(), "b error");
    EXPECT_EQ(finished_, 2);
}

TEST_F(Table1, PrintsRowsBelowItsHeader)
{
    const std::string header = markdown_header(), row = markdown_of(TableRow{"letters", "by move", {}});
    EXPECT_EQ(std::count(header.begin(), header.end(), '\n'), 2);
    EXPECT_EQ(std::count(row.begin(), row.end(), '|'), std::count(header.begin(), header.end(), '|') / 2);
}

} // namespace
} // namespace toile::research::paper
