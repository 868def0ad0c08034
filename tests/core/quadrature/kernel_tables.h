#pragma once

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/quadrature/tables/kernel_table.h"

namespace toile::test {

/// Max difference of weights, relative to the max weight [-]: other orders of summation, and rounding to
/// single precision.
constexpr double kWeightTolerance = 1e-6;

inline double largest_difference(const std::vector<float>& a, const std::vector<float>& b)
{
    double difference = 0.0, largest = 0.0;
    for (size_t i = 0; i < a.size(); ++i) {
        const double error = std::abs(double(a[i]) - double(b[i]));
        if (std::isnan(error))
            return error;
        difference = std::max(difference, error);
        largest = std::max(largest, std::abs(double(b[i])));
    }
    return difference / std::max(largest, 1e-300);
}

/// Expects the same lists, and weights within rounding.
inline void expect_equal_tables(const KernelTable& table, const KernelTable& expected)
{
    EXPECT_EQ(table.rank, expected.rank);
    EXPECT_EQ(table.near_first, expected.near_first);
    EXPECT_EQ(table.near_leaf, expected.near_leaf);
    EXPECT_EQ(table.far_first, expected.far_first);
    EXPECT_EQ(table.far_cluster, expected.far_cluster);
    ASSERT_EQ(table.near_weights.size(), expected.near_weights.size());
    ASSERT_EQ(table.far_weights.size(), expected.far_weights.size());
    EXPECT_LT(largest_difference(table.near_weights, expected.near_weights), kWeightTolerance);
    EXPECT_LT(largest_difference(table.far_weights, expected.far_weights), kWeightTolerance);
}

} // namespace toile::test
