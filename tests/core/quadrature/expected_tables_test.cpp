#include "core/quadrature/expected_tables.h"

#include <gtest/gtest.h>

namespace toile::test {

namespace {

/// Tables that were measured (docs/performance.md#tables).
struct Measured {
    int nodes;
    Extent extent;
    double seconds, megabytes; ///< 0: not measured
};

void expect_about(double expected, double measured, int nodes)
{
    if (measured > 0.0) {
        EXPECT_GT(expected, 0.6 * measured) << nodes;
        EXPECT_LT(expected, 2.1 * measured) << nodes;
    }
}

TEST(ExpectedTables, AgreeWithMeasuredOnesOnACpu)
{
    // Sheets with two threads, letters with one.
    for (const Measured& of :
         {Measured{2'500, Extent::Surface, 0.08, 1.8}, Measured{10'000, Extent::Surface, 0.72, 10.1},
          Measured{50'176, Extent::Surface, 24.8, 70.3}, Measured{812, Extent::Volume, 0.0, 0.6},
          Measured{3'381, Extent::Volume, 0.17, 3.5}, Measured{10'514, Extent::Volume, 4.3, 13.7},
          Measured{16'366, Extent::Volume, 11.3, 22.5}}) {
        const ExpectedTables tables = expected_tables(of.nodes, of.extent, 1);
        expect_about(tables.seconds, of.seconds, of.nodes);
        expect_about(tables.bytes, 1e6 * of.megabytes, of.nodes);
    }
}

TEST(ExpectedTables, AgreeWithMeasuredOnesOnAGpu)
{
    for (const Measured& of :
         {Measured{10'000, Extent::Surface, 0.083, 0.0}, Measured{50'176, Extent::Surface, 0.535, 27.7},
          Measured{240'100, Extent::Surface, 3.65, 0.0}, Measured{10'443, Extent::Volume, 0.28, 0.0}}) {
        const ExpectedTables tables = expected_tables_on_gpu(of.nodes, of.extent);
        expect_about(tables.seconds, of.seconds, of.nodes);
        expect_about(tables.bytes, 1e6 * of.megabytes, of.nodes);
    }
}

TEST(ExpectedTables, TakeLessTimeWithMoreThreads)
{
    EXPECT_DOUBLE_EQ(expected_tables(5'000, Extent::Volume, 4).seconds,
                     0.25 * expected_tables(5'000, Extent::Volume, 1).seconds);
}

} // namespace
} // namespace toile::test
