#include "core/quadrature/cuda/quadrature.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "core/compute/cuda/runtime/graph.h"
#include "core/linear/block_diagonal_solver.h"
#include "core/quadrature/cuda/quadrature_solver.h"
#include "core/quadrature/quadrature_operator.h"
#include "core/quadrature/quadrature_solver.h"
#include "tests/core/compute/cuda/on_device.h"
#include "tests/core/quadrature/quadrature_problems.h"

namespace toile::test {

namespace {

/// Max difference, relative to the max of the CPU's result [-]: single precision, in another order.
constexpr double kTolerance = 5e-6;

/// Max difference with byte weights [-]; for their effect on contraction see
/// tests/core/quadrature/packing_test.cpp.
constexpr double kToleranceOfBytes = 5e-4;

double largest(const std::vector<Vec3>& field)
{
    double max_value = 0.0;
    for (const Vec3& v : field)
        max_value = std::max(max_value, v.cwiseAbs().maxCoeff());
    return max_value;
}

double difference(std::vector<Vec3> a, const std::vector<Vec3>& b)
{
    for (size_t i = 0; i < a.size(); ++i)
        a[i] -= b[i];
    return largest(a) / largest(b);
}

class DeviceQuadratureTest : public OnDevice {
protected:
    void build(const SparseMatrix& H, const std::vector<unsigned char>& fixed,
               const std::vector<EmbeddedPoint>& points, const QuadratureTables::Settings& settings = {})
    {
        tables_ = build_tables({H, fixed, points, settings}, {});
        load_ = random_field(int(H.rows()), 3);
        b_ = std::make_unique<DeviceArray<Vec3>>(space(), "test/b");
        x_ = std::make_unique<DeviceArray<Vec3>>(space(), "test/x", int(H.rows()));
        b_->upload(load_);
        device_ = std::make_unique<DeviceQuadrature>(
            space(), *tables_, std::vector<std::vector<int>>{consecutive_rows(0, int(H.rows()))});
    }
    std::vector<Vec3> by_device()
    {
        x_->fill_zero();
        device_->solve(b_->view(), x_->view());
        return x_->downloaded();
    }
    std::vector<Vec3> by_cpu() const
    {
        std::vector<Vec3> x(load_.size());
        QuadratureOperator(tables_).solve(load_, x);
        return x;
    }
    DeviceQuadrature& device() { return *device_; }
    View<const Vec3> b() { return b_->view(); }
    DeviceArray<Vec3>& x() { return *x_; }

private:
    std::shared_ptr<const QuadratureTables> tables_;
    std::vector<Vec3> load_;
    std::unique_ptr<DeviceArray<Vec3>> b_, x_;
    std::unique_ptr<DeviceQuadrature> device_;
};

TEST_F(DeviceQuadratureTest, MatchesTheCpu)
{
    const Grid grid;
    for (const double shift : {1e-1, 1e-4}) {
        build(grid.matrix(shift), grid.fixed, grid.points);
        EXPECT_LT(difference(by_device(), by_cpu()), kTolerance) << shift;
    }
}

TEST_F(DeviceQuadratureTest, LeavesFixedNodesUnchanged)
{
    Grid grid;
    for (int v = 0; v < Grid::kColumns; ++v)
        grid.fixed[v] = 1;
    SparseMatrix H = grid.matrix(1e-2);
    for (int column = 0; column < H.cols(); ++column)
        for (SparseMatrix::InnerIterator entry(H, column); entry; ++entry)
            if (grid.fixed[entry.row()] || grid.fixed[entry.col()])
                entry.valueRef() = entry.row() == entry.col() ? 1.0 : 0.0;
    build(H, grid.fixed, grid.points);
    EXPECT_LT(difference(by_device(), by_cpu()), kTolerance);
    EXPECT_LT((by_device()[3] - by_cpu()[3]).norm(), 1e-7); // single precision, otherwise unchanged
}

TEST_F(DeviceQuadratureTest, HandlesVolumesAndTreesOfAnyHeight)
{
    const std::vector<EmbeddedPoint> cube = grid_points(10, 10, 10);
    build(grid_laplacian(10, 100, 1e-1), std::vector<unsigned char>(1000, 0), cube, {{0.07}, Extent::Volume});
    EXPECT_LT(difference(by_device(), by_cpu()), kTolerance);
    for (const int columns : {1, 8, 9, 16, 255, 256, 257, 300}) {
        build(grid_laplacian(columns, 1, 1e-2), std::vector<unsigned char>(columns, 0),
              grid_points(columns, 1));
        EXPECT_LT(difference(by_device(), by_cpu()), kTolerance) << columns;
    }
}

TEST_F(DeviceQuadratureTest, HasTheSameBitsFromAGraphAndAllocatesNothing)
{
    const Grid grid;
    build(grid.matrix(1e-3), grid.fixed, grid.points);
    const std::vector<Vec3> first = by_device();
    const long allocations = allocations_of([&] {
        CudaGraph graph(space(), "test/graph");
        graph.record([&] { device().solve(b(), x().view()); });
        for (int k = 0; k < 3; ++k) {
            x().fill_zero();
            graph.launch();
            EXPECT_EQ(x().downloaded(), first);
        }
    });
    EXPECT_EQ(allocations, 0);
}

/// Block-diagonal H of several grids.
SparseMatrix side_by_side(const std::vector<SparseMatrix>& blocks)
{
    Triplets entries;
    int first = 0;
    for (const SparseMatrix& block : blocks) {
        for (int row = 0; row < block.rows(); ++row)
            for (SparseMatrix::InnerIterator entry(block, row); entry; ++entry)
                entries.emplace_back(first + row, first + int(entry.col()), entry.value());
        first += int(block.rows());
    }
    SparseMatrix all(first, first);
    all.setFromTriplets(entries.begin(), entries.end());
    return all;
}

TEST_F(DeviceQuadratureTest, SolvesEqualAndDifferentBodiesWithTablesOfEitherBuilder)
{
    const Grid grid;
    const SparseMatrix soft = grid.matrix(1e-1), stiff = grid.matrix(1e-4);
    const SparseMatrix H = side_by_side({soft, stiff, soft});
    const std::vector<unsigned char> fixed(H.rows(), 0);
    const std::vector<Vec3> load = random_field(int(H.rows()), 5);

    std::vector<BlockDiagonalSolver::Block> blocks;
    blocks.reserve(3);
    for (int k = 0; k < 3; ++k)
        blocks.push_back({consecutive_rows(k * int(soft.rows()), int(soft.rows())),
                          std::make_unique<QuadratureSolver>(grid.points, QuadratureSolver::Settings{})});
    BlockDiagonalSolver cpu(std::move(blocks));
    cpu.update(H, fixed);
    std::vector<Vec3> expected(load.size()), found(load.size());
    cpu.solve(load, expected);

    // One store has the CPU's tables, the other has none.
    using Weights = DeviceQuadratureSolver::Weights;
    for (const auto& store : {TableStore::of_process(), std::make_shared<TableStore>()})
        for (const auto& [weights, tolerance] :
             {std::pair(Weights::Single, kTolerance), std::pair(Weights::Bytes, kToleranceOfBytes)}) {
            DeviceQuadratureSolver gpu(
                space(), std::vector<DeviceQuadratureSolver::Part>(3, {grid.points, {}}), store, weights);
            gpu.update(H, fixed);
            gpu.solve(load, found);
            EXPECT_LT(difference(found, expected), tolerance);
        }
}

/// Trees of any height, more of them than one launch takes, some of them equal.
TEST_F(DeviceQuadratureTest, HasTheSameBitsSideBySideAndAlone)
{
    const Grid grid;
    std::vector<SparseMatrix> blocks{grid.matrix(1e-1), grid.matrix(1e-4), grid.matrix(1e-1)};
    std::vector<DeviceQuadratureSolver::Part> parts(3, {grid.points, {}});
    for (const int columns : {1, 257, 8, 600, 9, 16, 600, 255, 300, 40}) {
        blocks.push_back(grid_laplacian(columns, 1, 1e-2));
        parts.push_back({grid_points(columns, 1), {}});
    }
    const SparseMatrix H = side_by_side(blocks);
    std::vector<unsigned char> fixed(H.rows(), 0);
    const std::vector<Vec3> load = random_field(int(H.rows()), 5);
    std::vector<Vec3> found(load.size());
    DeviceQuadratureSolver together(space(), parts, std::make_shared<TableStore>());
    together.update(H, fixed);
    together.solve(load, found);

    int first = 0;
    for (size_t k = 0; k < parts.size(); ++k) {
        const int count = int(parts[k].points.size());
        DeviceQuadratureSolver alone(space(), {parts[k]}, std::make_shared<TableStore>());
        alone.update(blocks[k], View<const unsigned char>(fixed).subview(first, count));
        std::vector<Vec3> expected(count);
        alone.solve(View<const Vec3>(load).subview(first, count), expected);
        EXPECT_EQ(std::vector<Vec3>(found.begin() + first, found.begin() + first + count), expected) << k;
        first += count;
    }
}

} // namespace
} // namespace toile::test
