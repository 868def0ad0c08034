#include "core/linear/field.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "core/linear/sparse_matrix.h"
#include "tests/core/linear/matrices.h"

namespace toile::test {
namespace {

/// Size of several reduction blocks and many grains, none of them full.
constexpr int kMany = 10007;

TEST(Field, DotSumsTheProducts)
{
    const std::vector<Vec3> a{{1, 2, 3}, {4, 5, 6}}, b{{1, 0, -1}, {2, 2, 2}};
    EXPECT_EQ(dot(a, b), -2.0 + 30.0);
    const std::vector<Vec3> none;
    EXPECT_EQ(dot(none, none), 0.0);

    const std::vector<Vec3> p = random_field(kMany, 1), q = random_field(kMany, 2);
    EXPECT_NEAR(dot(p, q), as_matrix(p).cwiseProduct(as_matrix(q)).sum(), 1e-10);
}

TEST(Field, DotHasTheSameBitsForAnyThreadCount)
{
    const std::vector<Vec3> p = random_field(kMany, 3), q = random_field(kMany, 4);
    const auto on = [&](int threads) {
        double result = 0.0;
        tbb::task_arena(threads).execute([&] { result = dot(p, q); });
        return result;
    };
    for (const int threads : {2, 3, 8})
        EXPECT_EQ(on(threads), on(1)) << threads << " threads";
}

TEST(Field, AxpyAddsAMultiple)
{
    const std::vector<Vec3> x = random_field(kMany, 5), start = random_field(kMany, 6);
    std::vector<Vec3> y = start;
    axpy(-0.25, x, y); // exact: a power of two
    for (int i = 0; i < kMany; ++i)
        ASSERT_EQ(y[i], Vec3(start[i] - 0.25 * x[i])) << i;
}

TEST(Field, XpayScalesTheTargetAndAdds)
{
    const std::vector<Vec3> x = random_field(kMany, 7), start = random_field(kMany, 8);
    std::vector<Vec3> y = start;
    xpay(x, 0.5, y);
    for (int i = 0; i < kMany; ++i)
        ASSERT_EQ(y[i], Vec3(x[i] + 0.5 * start[i])) << i;
}

TEST(Field, MaxNormIsTheLongestVector)
{
    EXPECT_EQ(max_norm(std::vector<Vec3>{{0, 3, 4}, {-1, 0, 0}, {0, 0, -2}}), 5.0);
    EXPECT_EQ(max_norm(std::vector<Vec3>{}), 0.0);
}

TEST(Field, MaxNormPropagatesNonFiniteValues)
{
    const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
    EXPECT_EQ(max_norm(std::vector<Vec3>{{1, 0, 0}, {0, inf, 0}, {2, 0, 0}}), inf);
    for (int index = 0; index < 4; ++index) {
        std::vector<Vec3> x(4, Vec3(1, 2, 3));
        x[index].y() = nan;
        EXPECT_TRUE(std::isnan(max_norm(x))) << "NaN at " << index;
    }
}

TEST(SparseMatrix, RowTimesIsARowOfTheProduct)
{
    const SparseMatrix A = random_spd(80, 1);
    const std::vector<Vec3> x = random_field(80, 2);
    const Eigen::MatrixX3d product = A * as_matrix(x);
    for (int i = 0; i < 80; ++i)
        EXPECT_LT((row_times(A, i, x) - product.row(i).transpose()).norm(), 1e-13);
}

} // namespace
} // namespace toile::test
