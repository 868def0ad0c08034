#include "core/quadrature/tables/background_tables.h"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/linear/direct_solver.h"
#include "core/quadrature/quadrature_solver.h"
#include "tests/core/quadrature/quadrature_problems.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

namespace {

/// A grid's matrix and the request for its tables.
BackgroundTables::Request request_for(int columns, int rows, double shift = 1e-3)
{
    std::vector<EmbeddedPoint> points = grid_points(columns, rows);
    return {grid_laplacian(columns, rows, shift),
            std::vector<unsigned char>(points.size(), 0),
            [points] { return points; },
            {}};
}

/// Waits for the requested tables.
std::shared_ptr<const QuadratureTables> awaited(BackgroundTables& background)
{
    for (int k = 0; k < 20000; ++k) {
        if (auto tables = background.take_if_ready())
            return tables;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ADD_FAILURE() << "no tables came";
    return nullptr;
}

/// Waits until a build is in progress.
void wait_for_progress(const BackgroundTables& background)
{
    while (background.progress() == 0.0)
        std::this_thread::yield();
}

TEST(BackgroundTables, MatchASynchronousBuild)
{
    const BackgroundTables::Request request = request_for(31, 23);
    const int n = int(request.H.rows());
    const std::vector<Vec3> b = random_field(n, 3);
    std::vector<Vec3> x(n), expected(n);
    QuadratureSolver waits(request.points(), {}, std::make_shared<TableStore>());
    waits.update(request.H, request.fixed);
    waits.solve(b, expected);

    for (const int threads : {1, 2}) {
        BackgroundTables background(std::make_shared<TableStore>(), threads);
        background.start(request);
        DirectSolver meanwhile;
        meanwhile.update(request.H, request.fixed);
        meanwhile.solve(b, x);
        EXPECT_LT((as_matrix(x) - as_matrix(expected)).norm(), 0.1 * as_matrix(expected).norm());
        const QuadratureOperator switched(awaited(background));
        switched.solve(b, x);
        EXPECT_EQ(x, expected) << "bit by bit";
        EXPECT_EQ(background.progress(), 1.0);
        EXPECT_EQ(background.take_if_ready(), nullptr) << "they have been taken";
    }
}

class BackgroundTablesOnDisk : public FileTest {
protected:
    /// True if the tables of `request` were finished: then they are on disk.
    bool was_finished(const BackgroundTables::Request& request) const
    {
        const std::vector<EmbeddedPoint> points = request.points();
        const Hash128 key = table_key({request.H, request.fixed, points, request.settings});
        return std::filesystem::exists(TableCache(folder_).file_of(key));
    }

    std::shared_ptr<TableStore> store_ = std::make_shared<TableStore>(folder_);
};

TEST_F(BackgroundTablesOnDisk, AreCancelledWhenNoLongerWanted)
{
    const BackgroundTables::Request large = request_for(70, 70);
    {
        BackgroundTables background(store_);
        background.start(large);
        wait_for_progress(background);
    }
    EXPECT_FALSE(was_finished(large));
    {
        BackgroundTables background(store_);
        background.start(large); // cancelled before it starts
    }
    EXPECT_FALSE(was_finished(large));
}

TEST_F(BackgroundTablesOnDisk, AreThoseOfTheLastRequest)
{
    const BackgroundTables::Request large = request_for(70, 70), small = request_for(20, 20);
    BackgroundTables background(store_);
    background.start(large);
    wait_for_progress(background);
    background.start(small);
    const auto tables = awaited(background);
    EXPECT_EQ(tables->tree.leaf_count(), 50);
    EXPECT_FALSE(was_finished(large));
    EXPECT_TRUE(was_finished(small));
}

TEST_F(BackgroundTablesOnDisk, AreForgottenWhenTheyAreCancelled)
{
    const BackgroundTables::Request large = request_for(70, 70);
    BackgroundTables background(store_);
    background.start(large);
    wait_for_progress(background);
    background.cancel();
    EXPECT_EQ(background.progress(), 0.0);
    background.start(request_for(20, 20));
    EXPECT_EQ(awaited(background)->tree.leaf_count(), 50);
    EXPECT_FALSE(was_finished(large));
}

TEST_F(BackgroundTablesOnDisk, AreOnlyReadWhenOnlyStoredOnesAreRequested)
{
    BackgroundTables::Request request = request_for(20, 20);
    request.only_stored = true;
    BackgroundTables background(store_);
    background.start(request);
    wait_for_progress(background);
    EXPECT_EQ(background.take_if_ready(), nullptr);
    EXPECT_FALSE(was_finished(request));
    store_->get({request.H, request.fixed, request.points(), request.settings});
    EXPECT_TRUE(was_finished(request));
    background.start(request);
    EXPECT_NE(awaited(background), nullptr);
}

TEST(BackgroundTables, ReportFailures)
{
    BackgroundTables background(std::make_shared<TableStore>());
    background.start(request_for(20, 20, -5.0));
    EXPECT_NE(refusal([&] { awaited(background); }).find("not positive definite"), std::string::npos);
    EXPECT_EQ(background.take_if_ready(), nullptr) << "told once";
    background.start(request_for(20, 20));
    EXPECT_NE(awaited(background), nullptr);
}

TEST(BackgroundTables, DoNothingUntilRequested)
{
    BackgroundTables background(std::make_shared<TableStore>());
    EXPECT_EQ(background.take_if_ready(), nullptr);
    EXPECT_EQ(background.progress(), 0.0);
}

} // namespace
} // namespace toile::test
