#include "core/quadrature/tables/table_store.h"

#include <atomic>
#include <cmath>
#include <latch>
#include <limits>
#include <numeric>
#include <thread>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "core/base/error.h"
#include "core/base/stages.h"
#include "core/linear/direct_solver.h"
#include "core/quadrature/quadrature_solver.h"
#include "tests/core/quadrature/quadrature_problems.h"

namespace toile::test {

namespace {

/// Number of builds of tables by action().
template <typename Action>
long builds(const Action& action)
{
    Stages stages;
    {
        const Stages::Activate recording(stages);
        action();
    }
    return stages.calls("quadrature/build");
}

/// Body with a separate store, so that tests do not share tables.
struct Body {
    Grid grid;
    std::shared_ptr<TableStore> store = std::make_shared<TableStore>();
    SparseMatrix H = grid.matrix(1e-3);

    TableInput input() const { return {H, grid.fixed, grid.points, {}}; }
    QuadratureSolver solver() const { return QuadratureSolver(grid.points, {}, store); }
};

TEST(TableStore, BuildsOnceForEqualBodies)
{
    const Body body;
    QuadratureSolver one = body.solver(), two = body.solver(), other = body.solver();
    const SparseMatrix copy = body.H, different = body.grid.matrix(2e-3);
    EXPECT_EQ(builds([&] {
                  one.update(body.H, body.grid.fixed);
                  two.update(copy, body.grid.fixed);
              }),
              1);
    EXPECT_EQ(&one.table(), &two.table());
    EXPECT_EQ(builds([&] { other.update(different, body.grid.fixed); }), 1);
}

TEST(TableStore, ReusesTheTablesOfAnEarlierTimeStep)
{
    const Body body;
    QuadratureSolver one = body.solver(), two = body.solver();
    const SparseMatrix other_step = body.grid.matrix(4e-3);
    one.update(body.H, body.grid.fixed);
    two.update(body.H, body.grid.fixed);
    EXPECT_EQ(builds([&] { one.update(other_step, body.grid.fixed); }), 1);
    EXPECT_EQ(builds([&] { one.update(body.H, body.grid.fixed); }), 0) << "the other body still has them";
}

TEST(TableStore, ReleasesUnusedTables)
{
    const Body body;
    std::weak_ptr<const QuadratureTables> tables = body.store->get(body.input());
    EXPECT_TRUE(tables.expired());
    EXPECT_EQ(builds([&] { body.store->get(body.input()); }), 1);
}

TEST(TableStore, SharesOneBuildBetweenWaitingThreads)
{
    const Body body;
    constexpr int kThreads = 4;
    std::latch together(kThreads);
    std::vector<std::shared_ptr<const QuadratureTables>> found(kThreads);
    std::vector<long> built(kThreads);
    std::vector<std::thread> threads(kThreads);
    for (int k = 0; k < kThreads; ++k)
        threads[k] = std::thread([&, k] {
            together.arrive_and_wait();
            built[k] = builds([&] { found[k] = body.store->get(body.input()); });
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(std::accumulate(built.begin(), built.end(), 0L), 1);
    for (const auto& tables : found)
        EXPECT_EQ(tables, found[0]);
}

TEST(TableStore, PassesAnAbandonedBuildToAWaitingCaller)
{
    const Body body;
    std::atomic<bool> somebody_waits = false;
    std::latch has_begun(1);
    std::thread abandons([&] {
        bool is_first = true;
        const auto progress = [&](double) {
            if (is_first)
                has_begun.count_down();
            is_first = false;
            somebody_waits.wait(false);
            return false;
        };
        const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
        EXPECT_THROW(body.store->get(body.input(), {progress}), Cancelled);
    });
    has_begun.wait();
    const auto tables = body.store->get(body.input(), {[&](double) {
                                            somebody_waits = true;
                                            somebody_waits.notify_all();
                                            return true;
                                        }});
    abandons.join();
    EXPECT_NE(tables, nullptr);
}

TEST(TableStore, LetsAWaitingThreadCancelAlone)
{
    const Body body;
    std::latch has_begun(1), has_given_up(1);
    std::shared_ptr<const QuadratureTables> tables;
    std::thread builder([&] {
        std::atomic<bool> is_first = true;
        tables = body.store->get(body.input(), {[&](double) {
                                     if (is_first.exchange(false)) {
                                         has_begun.count_down();
                                         has_given_up.wait();
                                     }
                                     return true;
                                 }});
    });
    has_begun.wait();
    EXPECT_THROW(body.store->get(body.input(), {[](double) { return false; }}), Cancelled);
    has_given_up.count_down();
    builder.join();
    EXPECT_NE(tables, nullptr);
}

TEST(TableStore, DistinguishesAllInputsOfTheTables)
{
    Body body;
    const Hash128 key = table_key(body.input());
    EXPECT_EQ(table_key(Body().input()), key);

    SparseMatrix close = body.H;
    close.valuePtr()[77] = std::nextafter(close.valuePtr()[77], 9.0);
    EXPECT_NE(table_key({close, body.grid.fixed, body.grid.points, {}}), key) << "a value's last bit";
    SparseMatrix more = body.H;
    more.coeffRef(0, 5) = 0.0;
    more.makeCompressed();
    EXPECT_NE(table_key({more, body.grid.fixed, body.grid.points, {}}), key) << "the pattern";
    std::vector<unsigned char> fixed = body.grid.fixed;
    fixed[9] = 1;
    EXPECT_NE(table_key({body.H, fixed, body.grid.points, {}}), key) << "a held node";
    std::vector<EmbeddedPoint> points = body.grid.points;
    points[3][1] += 1e-12;
    EXPECT_NE(table_key({body.H, body.grid.fixed, points, {}}), key) << "a place";
    EXPECT_NE(table_key({body.H, body.grid.fixed, body.grid.points, {{0.1}}}), key) << "the tolerance";
    EXPECT_NE(table_key({body.H, body.grid.fixed, body.grid.points, {{}, Extent::Volume}}), key);
}

TEST(TableStore, LeavesASolverUnchangedWhenItsUpdateIsCancelled)
{
    const Body body;
    bool wants_more = true;
    QuadratureSolver solver(body.grid.points, {}, body.store, {[&](double) { return wants_more; }});
    solver.update(body.H, body.grid.fixed);
    const std::vector<Vec3> b = random_field(int(body.grid.points.size()), 2);
    std::vector<Vec3> before(b.size()), after(b.size());
    solver.solve(b, before);
    wants_more = false;
    EXPECT_THROW(solver.update(body.grid.matrix(1e-2), body.grid.fixed), Cancelled);
    solver.solve(b, after);
    EXPECT_EQ(after, before);
    wants_more = true;
    solver.update(body.grid.matrix(1e-2), body.grid.fixed);
    solver.solve(b, after);
    EXPECT_NE(after, before);
}

TEST(DirectSolver, FactorsOnceForEqualMatrices)
{
    const SparseMatrix H = grid_laplacian(12, 11, 0.0123), equal = grid_laplacian(12, 11, 0.0123),
                       other = grid_laplacian(12, 11, 0.0456);
    const std::vector<unsigned char> fixed(H.rows(), 0);
    const std::vector<Vec3> b = random_field(int(H.rows()), 2);
    std::vector<Vec3> x(b.size()), y(b.size());
    DirectSolver one, two;
    Stages stages;
    const Stages::Activate recording(stages);
    one.update(H, fixed);
    two.update(equal, fixed);
    EXPECT_EQ(stages.calls("linear/factor"), 1);
    one.solve(b, x);
    two.solve(b, y);
    EXPECT_EQ(x, y);

    two.update(other, fixed);
    EXPECT_EQ(stages.calls("linear/factor"), 2);
    one.solve(b, y);
    EXPECT_EQ(x, y) << "the other's new factor must not reach it";
    one.update(other, fixed);
    EXPECT_EQ(stages.calls("linear/factor"), 2);
    one.solve(b, x);
    two.solve(b, y);
    EXPECT_EQ(x, y);
}

TEST(Hasher, DependsOnTheBytesAlone)
{
    Hasher whole, pieces, other;
    whole.add_bytes("table", 5);
    pieces.add_bytes("ta", 2);
    pieces.add_bytes("ble", 3);
    other.add_bytes("tables", 6);
    EXPECT_EQ(whole.result(), pieces.result());
    EXPECT_NE(whole.result(), other.result());
    // XXH3 of nothing with seed 0, as published with the algorithm.
    EXPECT_EQ(to_hex(Hasher().result()), "99aa06d3014798d86001c324468d497f");
}

} // namespace
} // namespace toile::test
