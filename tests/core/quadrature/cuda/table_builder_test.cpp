#include "core/quadrature/cuda/table_builder.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "core/base/error.h"
#include "core/linear/cholesky.h"
#include "core/quadrature/cuda/quadrature.h"
#include "core/quadrature/quadrature_operator.h"
#include "tests/core/compute/cuda/on_device.h"
#include "tests/core/compute/cuda/taken_memory.h"
#include "tests/core/quadrature/kernel_tables.h"
#include "tests/core/quadrature/quadrature_problems.h"

namespace toile::test {

namespace {

/// A matrix, its points and its free nodes.
struct Problem {
    SparseMatrix H;
    std::vector<EmbeddedPoint> points;
    std::vector<unsigned char> fixed;
    QuadratureTables::Settings settings;

    Problem(const SparseMatrix& matrix, std::vector<EmbeddedPoint> where,
            const QuadratureTables::Settings& how = {})
        : H(matrix), points(std::move(where)), fixed(points.size(), 0), settings(how)
    {
    }
    void fix(int v)
    {
        isolate(H, v);
        fixed[v] = 1;
    }
    TableInput input() const { return {H, fixed, points, settings}; }
};

Problem grid(int columns, int rows, double shift)
{
    return {grid_laplacian(columns, rows, shift), grid_points(columns, rows)};
}

class DeviceTableBuilderTest : public OnDevice {
protected:
    /// Tables of one problem by the host and the device.
    struct Tables {
        std::shared_ptr<const QuadratureTables> host;
        std::optional<DeviceKernelTable> device;
    };

    std::optional<DeviceKernelTable> built(const Problem& problem, const ClusterBasis& basis,
                                           const BuildProgress& progress = {}) const
    {
        const Eigen::VectorXd diagonal = problem.H.diagonal();
        return build_kernel_table(space(), Cholesky(problem.H).factor(),
                                  {diagonal.data(), int(diagonal.size())}, basis, problem.settings.kernel,
                                  progress);
    }

    /// Table by a builder with blocks of so many columns.
    KernelTable built_in_blocks(const Problem& problem, const ClusterBasis& basis, int columns) const
    {
        const InvertedFactor factor(Cholesky(problem.H).factor());
        const Eigen::VectorXd diagonal = problem.H.diagonal();
        DeviceTableBuilder builder(space(), factor, {diagonal.data(), int(diagonal.size())}, basis,
                                   problem.settings.kernel, columns);
        for (int block = 0; block < builder.block_count(); ++block) {
            builder.solve(block);
            builder.gather_moments();
            builder.append_lists();
        }
        return builder.take().downloaded();
    }

    void expect_tables_of_the_cpu(const Problem& problem) const
    {
        const std::shared_ptr<const QuadratureTables> tables = build_tables(problem.input(), {});
        const std::optional<DeviceKernelTable> table = built(problem, tables->basis);
        ASSERT_TRUE(table.has_value());
        expect_equal_tables(table->downloaded(), tables->kernel);
    }
};

TEST_F(DeviceTableBuilderTest, MatchesTheTablesOfTheCpu)
{
    for (const double shift : {1e-1, 1e-4})
        expect_tables_of_the_cpu(grid(23, 17, shift));
    expect_tables_of_the_cpu(grid(70, 64, 1e-3));
    expect_tables_of_the_cpu({cloth_matrix(70, 50, 20.0), grid_points(70, 50)});
}

TEST_F(DeviceTableBuilderTest, SkipsFixedNodes)
{
    Problem problem = grid(50, 40, 1e-2);
    for (int v = 0; v < 2000; v += v < 50 ? 1 : 97)
        problem.fix(v);
    expect_tables_of_the_cpu(problem);
    Problem nothing = grid(3, 3, 1e-2);
    for (int v = 0; v < 9; ++v)
        nothing.fix(v);
    expect_tables_of_the_cpu(nothing);
}

TEST_F(DeviceTableBuilderTest, HandlesVolumesAndTreesOfAnyHeight)
{
    expect_tables_of_the_cpu(
        {grid_laplacian(10, 100, 1e-1), grid_points(10, 10, 10), {{0.07}, Extent::Volume}});
    for (const int columns : {1, 8, 9, 16, 128, 129, 1025})
        expect_tables_of_the_cpu(grid(columns, 1, 1e-2));
}

TEST_F(DeviceTableBuilderTest, HandlesDisconnectedParts)
{
    Problem problem = grid(40, 40, 1e-3);
    for (SparseMatrix::Index row = 0; row < problem.H.outerSize(); ++row)
        for (SparseMatrix::InnerIterator entry(problem.H, row); entry; ++entry)
            if ((entry.row() % 40 < 13) != (entry.col() % 40 < 13))
                entry.valueRef() = 0.0;
    problem.H.prune(0.0);
    problem.H.makeCompressed();
    expect_tables_of_the_cpu(problem);
}

TEST_F(DeviceTableBuilderTest, HasTheSameBitsForAnyBlockSize)
{
    const Problem problem = grid(50, 31, 1e-3);
    const std::shared_ptr<const QuadratureTables> tables = begin_tables(problem.input());
    const KernelTable first = built(problem, tables->basis)->downloaded();
    for (const int columns : {128, 128, 256, 4096}) {
        const KernelTable again = built_in_blocks(problem, tables->basis, columns);
        EXPECT_EQ(again.near_first, first.near_first);
        EXPECT_EQ(again.near_leaf, first.near_leaf);
        EXPECT_EQ(again.near_weights, first.near_weights);
        EXPECT_EQ(again.far_first, first.far_first);
        EXPECT_EQ(again.far_cluster, first.far_cluster);
        EXPECT_EQ(again.far_weights, first.far_weights);
    }
}

TEST_F(DeviceTableBuilderTest, CanBeCancelled)
{
    const Problem problem = grid(60, 50, 1e-3);
    const std::shared_ptr<const QuadratureTables> tables = begin_tables(problem.input());
    std::vector<double> fractions;
    EXPECT_FALSE(built(problem, tables->basis, [&](double fraction) {
                     fractions.push_back(fraction);
                     return fractions.size() < 2;
                 }).has_value());
    EXPECT_EQ(fractions.size(), 2u);
    fractions.clear();
    EXPECT_TRUE(built(problem, tables->basis, [&](double fraction) {
                    fractions.push_back(fraction);
                    return true;
                }).has_value());
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    EXPECT_EQ(fractions.back(), 1.0);
}

TEST_F(DeviceTableBuilderTest, SolvesWithTablesThatStayOnTheDevice)
{
    const Problem problem = grid(50, 40, 1e-3);
    const std::shared_ptr<const QuadratureTables> tables = build_tables(problem.input(), {});
    DeviceQuadrature device(space(), tables->basis, *built(problem, tables->basis),
                            {consecutive_rows(0, int(problem.H.rows()))});
    const std::vector<Vec3> load = random_field(int(problem.H.rows()), 3);
    DeviceArray<Vec3> b(space(), "test/b"), x(space(), "test/x", int(load.size()));
    b.upload(load);
    device.solve(b.view(), x.view());
    std::vector<Vec3> expected(load.size());
    QuadratureOperator(tables).solve(load, expected);
    const std::vector<Vec3> solved = x.downloaded();
    double largest = 0.0, difference = 0.0;
    for (size_t i = 0; i < load.size(); ++i) {
        largest = std::max(largest, expected[i].cwiseAbs().maxCoeff());
        difference = std::max(difference, (solved[i] - expected[i]).cwiseAbs().maxCoeff());
    }
    EXPECT_LT(difference, 3e-6 * largest);
}

TEST_F(DeviceTableBuilderTest, UsesSmallerBlocksWhenMemoryIsShort)
{
    const Problem problem = grid(150, 150, 1e-3);
    const std::shared_ptr<const QuadratureTables> tables = build_tables(problem.input(), {});
    const KernelTable table = built(problem, tables->basis)->downloaded();
    const auto taken = take_all_but(std::size_t(200) << 20, space());
    int calls = 0;
    const std::optional<DeviceKernelTable> again = built(problem, tables->basis, [&](double) {
        ++calls;
        return true;
    });
    EXPECT_GT(calls, 22500 / DeviceTableBuilder::kMaxColumns + 1);
    expect_equal_tables(again->downloaded(), tables->kernel);
    EXPECT_EQ(again->far_weights.downloaded(), table.far_weights);
}

TEST_F(DeviceTableBuilderTest, RefusesInAdvanceWhenMemoryIsTooSmall)
{
    const auto taken = take_all_but(std::size_t(64) << 20, space());
    const Problem problem = grid(150, 150, 1e-3);
    const std::shared_ptr<const QuadratureTables> tables = begin_tables(problem.input());
    const std::string message = message_of<DeviceError>([&] { built(problem, tables->basis); });
    EXPECT_TRUE(contains_in_order(message, "CUDA device 0 (",
                                  ") is out of memory: quadrature tables of 22500 nodes", " MiB, ",
                                  " MiB are free"))
        << message;
}

} // namespace
} // namespace toile::test
