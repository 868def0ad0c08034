#include "core/quadrature/auto_solver.h"

#include <chrono>
#include <future>
#include <thread>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/compute/parallel.h"
#include "core/pd/step/body.h"
#include "core/quadrature/quadrature_solver.h"
#include "tests/core/quadrature/quadrature_problems.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

namespace {

void rest() { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }

/// Costs set by a test. By default quadrature is always faster and tables are free.
struct Costs {
    SolveCosts expected{1.0, 0.0, 0.0};
    SolveCosts measured{1.0, 0.0, 0.0};

    AutoSolver::Settings settings() const
    {
        AutoSolver::Settings settings;
        settings.min_vertices = 0;
        settings.min_solves = 0;
        settings.expect = [costs = expected](const SupernodalFactor&) { return costs; };
        settings.measure = [costs = measured](const SupernodalFactor&, const QuadratureOperator&) {
            return costs;
        };
        return settings;
    }
};

/// A grid, its solver, and a record of reported events.
class AutoSolverTest : public testing::Test {
protected:
    std::unique_ptr<AutoSolver> solver(const Costs& costs = {}) { return solver(costs.settings()); }
    std::unique_ptr<AutoSolver> solver(const AutoSolver::Settings& settings)
    {
        return std::make_unique<AutoSolver>(
            [this] {
                ++embeddings_made_;
                return grid_.points;
            },
            store_, [this](const std::string& text) { warnings_.push_back(text); }, settings);
    }

    std::vector<Vec3> solved(const GlobalSolver& solver) const
    {
        std::vector<Vec3> x(b_.size());
        solver.solve(b_, x);
        return x;
    }
    std::vector<Vec3> by_factor(const SparseMatrix& H) const
    {
        DirectSolver direct;
        direct.update(H, grid_.fixed);
        return solved(direct);
    }
    std::vector<Vec3> by_quadrature(const SparseMatrix& H) const
    {
        QuadratureSolver quadrature(grid_.points, {}, std::make_shared<TableStore>());
        quadrature.update(H, grid_.fixed);
        return solved(quadrature);
    }

    /// Begins steps until the solver has switched.
    void await_switch(AutoSolver& solver) const
    {
        for (int k = 0; k < 20000 && solver.is_symmetric(); ++k) {
            solver.begin_step();
            rest();
        }
        EXPECT_FALSE(solver.is_symmetric()) << "it did not switch";
    }

    /// Begins steps until stage `name` was entered `calls` times.
    void await_stage(AutoSolver& solver, const char* name, long calls) const
    {
        for (int k = 0; k < 20000 && stages_.calls(name) < calls; ++k) {
            solver.begin_step();
            rest();
        }
        EXPECT_EQ(stages_.calls(name), calls) << name;
    }

    ThreadLimit two_threads_{2}; ///< on machines with one core too
    Stages stages_;
    Stages::Activate activate_{stages_};
    Grid grid_;
    SparseMatrix H_ = grid_.matrix(1e-3), other_H_ = grid_.matrix(1e-1);
    std::vector<Vec3> b_ = random_field(int(H_.rows()), 3);
    std::shared_ptr<TableStore> store_ = std::make_shared<TableStore>();
    std::atomic<int> embeddings_made_ = 0;
    std::vector<std::string> warnings_;
};

TEST_F(AutoSolverTest, SwitchesBetweenStepsAndThenHasTheBitsOfQuadrature)
{
    const auto solver = this->solver();
    solver->update(H_, grid_.fixed);
    EXPECT_EQ(solved(*solver), by_factor(H_));
    await_switch(*solver);
    EXPECT_EQ(solved(*solver), by_quadrature(H_));
    EXPECT_EQ(stages_.calls("auto/prepare"), 1);
    EXPECT_EQ(stages_.calls("auto/rehearse"), 2);
    EXPECT_EQ(stages_.calls("auto/begin"), 1);
    EXPECT_EQ(stages_.calls("auto/switch"), 1);
    EXPECT_EQ(embeddings_made_, 1);
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(AutoSolverTest, ReturnsToTheFactorWhenHChanges)
{
    const auto solver = this->solver();
    solver->update(H_, grid_.fixed);
    await_switch(*solver);
    solver->update(other_H_, grid_.fixed);
    EXPECT_TRUE(solver->is_symmetric());
    EXPECT_EQ(solved(*solver), by_factor(other_H_));
    await_switch(*solver);
    EXPECT_EQ(solved(*solver), by_quadrature(other_H_));

    // Other fixed nodes are another H too.
    grid_.fixed[7] = 1;
    isolate(H_, 7);
    solver->update(H_, grid_.fixed);
    EXPECT_EQ(solved(*solver), by_factor(H_));
    await_switch(*solver);
    EXPECT_EQ(solved(*solver), by_quadrature(H_));
    EXPECT_EQ(solved(*solver)[7], b_[7]);
    EXPECT_EQ(stages_.calls("auto/prepare"), 3);
    EXPECT_EQ(stages_.calls("auto/switch"), 3);
    EXPECT_EQ(embeddings_made_, 1) << "where the nodes are does not depend on H";
}

TEST_F(AutoSolverTest, NeverTakesTablesOfAnEarlierH)
{
    const auto solver = this->solver();
    const SparseMatrix* matrices[] = {&H_, &other_H_};
    for (int k = 0; k < 20; ++k) { // changed at every stage of a build
        solver->update(*matrices[k % 2], grid_.fixed);
        solver->begin_step();
        std::this_thread::sleep_for(std::chrono::milliseconds(3 * k));
        EXPECT_EQ(solved(*solver), by_factor(*matrices[k % 2]));
    }
    await_switch(*solver);
    EXPECT_EQ(solved(*solver), by_quadrature(other_H_));
}

TEST_F(AutoSolverTest, StaysWithTheFactorWhenItIsFaster)
{
    Costs costs;
    costs.expected = {1.0, 0.95, 0.0}; // not faster: it takes more solves
    const auto solver = this->solver(costs);
    solver->update(H_, grid_.fixed);
    for (int k = 0; k < 5; ++k)
        solver->begin_step();
    EXPECT_EQ(stages_.calls("auto/rehearse"), 1);
    EXPECT_EQ(stages_.calls("auto/search"), 0);
    EXPECT_EQ(stages_.calls("auto/begin"), 0);
}

TEST_F(AutoSolverTest, DropsTablesSlowerThanExpected)
{
    Costs costs;
    costs.measured = {1.0, 0.95, 0.0};
    const auto solver = this->solver(costs);
    solver->update(H_, grid_.fixed);
    await_stage(*solver, "auto/rehearse", 2);
    for (int k = 0; k < 5; ++k)
        solver->begin_step();
    EXPECT_TRUE(solver->is_symmetric());
    EXPECT_EQ(solved(*solver), by_factor(H_));
    EXPECT_EQ(stages_.calls("auto/begin"), 1) << "not for this H again";
    EXPECT_EQ(stages_.calls("auto/switch"), 0);
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(AutoSolverTest, StartsTablesOnceTheFactorHasLostTheirCost)
{
    Costs costs;
    costs.expected = {2.08, 1.0, 9.5}; // the factor loses 1 s a solve
    AutoSolver::Settings settings = costs.settings();
    settings.min_solves = 4;
    const auto solver = this->solver(settings);
    solver->update(H_, grid_.fixed);
    for (int k = 0; k < 10; ++k) {
        solver->begin_step();
        EXPECT_EQ(stages_.calls("auto/rehearse"), k < 4 ? 0 : 1) << k;
        EXPECT_EQ(stages_.calls("auto/begin"), 0) << k;
        solved(*solver);
    }
    solver->begin_step();
    EXPECT_EQ(stages_.calls("auto/begin"), 1);
    solver->update(other_H_, grid_.fixed);
    solver->begin_step();
    EXPECT_EQ(stages_.calls("auto/begin"), 1) << "what was lost with one H does not pay for another";
}

TEST_F(AutoSolverTest, TakesStoredTablesWithoutBuilding)
{
    Costs costs;
    costs.expected.build = 1e9;
    QuadratureSolver user(grid_.points, {}, store_);
    user.update(H_, grid_.fixed);
    const auto solver = this->solver(costs);
    solver->update(H_, grid_.fixed);
    await_switch(*solver);
    EXPECT_EQ(stages_.calls("auto/begin"), 0);
    EXPECT_EQ(solved(*solver), solved(user));

    // There are none for another H.
    solver->update(other_H_, grid_.fixed);
    solver->begin_step();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    solver->begin_step();
    EXPECT_EQ(stages_.calls("auto/search"), 2);
    EXPECT_TRUE(solver->is_symmetric());
    EXPECT_FALSE(store_->contains({other_H_, grid_.fixed, grid_.points, {}}));
}

TEST_F(AutoSolverTest, SpendsNothingOnSmallBodies)
{
    AutoSolver::Settings settings = Costs().settings();
    settings.min_vertices = int(H_.rows()) + 1;
    const auto solver = this->solver(settings);
    solver->update(H_, grid_.fixed);
    for (int k = 0; k < 5; ++k)
        solver->begin_step();
    EXPECT_EQ(stages_.calls("auto/rehearse"), 0);
    EXPECT_EQ(embeddings_made_, 0);
}

TEST_F(AutoSolverTest, BuildsNothingBesideASimulationOnOneThread)
{
    const ThreadLimit one(1);
    const auto solver = this->solver();
    solver->update(H_, grid_.fixed);
    for (int k = 0; k < 5; ++k)
        solver->begin_step();
    EXPECT_EQ(stages_.calls("auto/rehearse"), 0);
    EXPECT_EQ(embeddings_made_, 0);
}

TEST_F(AutoSolverTest, WarnsOnceAndStaysWithTheFactorWhenTablesFail)
{
    const auto warn = [this](const std::string& text) { warnings_.push_back(text); };
    AutoSolver solver([]() -> std::vector<EmbeddedPoint> { throw InvalidInput("no places here"); }, store_,
                      warn, Costs().settings());
    for (const SparseMatrix* H : {&H_, &other_H_}) {
        solver.update(*H, grid_.fixed);
        await_stage(solver, "auto/fail", 1);
        solver.begin_step();
        EXPECT_EQ(solved(solver), by_factor(*H));
    }
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_NE(warnings_[0].find("no places here; the direct solver"), std::string::npos) << warnings_[0];
}

TEST_F(AutoSolverTest, ReportsBackgroundWarningsBetweenSteps)
{
    const TemporaryFolder folder;
    const auto file = folder.write("file", ""); // no folder can be made in it
    store_ = std::make_shared<TableStore>(file / "cache");
    const std::thread::id main_thread = std::this_thread::get_id();
    AutoSolver solver([this] { return grid_.points; }, store_,
                      [&](const std::string& text) {
                          EXPECT_EQ(std::this_thread::get_id(), main_thread);
                          warnings_.push_back(text);
                      },
                      Costs().settings());
    solver.update(H_, grid_.fixed);
    await_switch(solver);
    solver.begin_step();
    EXPECT_EQ(warnings_.size(), 1u);
}

/// The destructor ends the build and leaves no dangling use.
TEST_F(AutoSolverTest, CancelsABuildWhenDestroyed)
{
    std::promise<void> begun;
    {
        AutoSolver solver(
            [&] {
                begun.set_value();
                return grid_.points;
            },
            store_, nullptr, Costs().settings());
        solver.update(H_, grid_.fixed);
        solver.begin_step();
        begun.get_future().wait();
    } // hangs if the destructor does not end the build
}

TEST_F(AutoSolverTest, FactorsOnceForEqualBodiesAndTheirTables)
{
    const auto one = solver(), two = solver();
    for (AutoSolver* solver : {one.get(), two.get()})
        solver->update(H_, grid_.fixed);
    EXPECT_EQ(stages_.calls("linear/factor"), 1);
    await_switch(*one);
    await_switch(*two);
    EXPECT_EQ(solved(*one), solved(*two));
}

/// Pulls every vertex towards its start and inspects the solver at every evaluation.
class Spy : public Energy {
public:
    Spy(const SparseMatrix& laplacian, std::vector<Vec3> center)
        : laplacian_(laplacian), center_(std::move(center))
    {
    }
    std::string_view name() const override { return "test/spy"; }
    void add_hessian(Triplets& H) const override
    {
        for (int row = 0; row < laplacian_.outerSize(); ++row)
            for (SparseMatrix::InnerIterator entry(laplacian_, row); entry; ++entry)
                H.emplace_back(row, int(entry.col()), entry.value());
    }
    double add_gradient(View<const Vec3> x, View<Vec3> gradient) override
    {
        inspect();
        std::vector<Vec3> away(x.begin(), x.end());
        for (int i = 0; i < x.size(); ++i)
            away[i] -= center_[i];
        double value = 0.0;
        for (int i = 0; i < x.size(); ++i) {
            const Vec3 force = row_times(laplacian_, i, away);
            gradient[i] += force;
            value += 0.5 * away[i].dot(force);
        }
        return value;
    }

    std::function<void()> inspect;

private:
    SparseMatrix laplacian_;
    std::vector<Vec3> center_; ///< targets of the pull
};

TEST_F(AutoSolverTest, NeverSwitchesWithinAStep)
{
    const int n = int(H_.rows());
    std::vector<Vec3> center(n);
    for (int i = 0; i < n; ++i)
        center[i] = grid_.points[i].head<3>();
    const auto spy = std::make_shared<Spy>(H_, center);
    auto owned = solver();
    const AutoSolver& solver = *owned;
    auto system = std::make_unique<System>(std::vector<double>(n, 1e-3),
                                           std::vector<std::shared_ptr<Energy>>{spy}, std::move(owned));
    const System& observed = *system;
    Body body(center, std::move(system), {});

    const std::vector<Vec3> acceleration = random_field(n, 9), targets(n);
    std::vector<bool> seen; // in one step
    spy->inspect = [&] {
        seen.push_back(solver.is_symmetric());
        const TableInput input{observed.matrix(), grid_.fixed, grid_.points, {}};
        for (int k = 0; k < 20000 && solver.is_symmetric() && !store_->contains(input); ++k)
            rest();
    };
    bool was_symmetric = true;
    int steps = 0;
    for (; steps < 200 && was_symmetric; ++steps) {
        seen.clear();
        EXPECT_EQ(body.step(0.1, acceleration, grid_.fixed, targets, nullptr, nullptr).steps, 1);
        ASSERT_FALSE(seen.empty());
        EXPECT_EQ(std::count(seen.begin(), seen.end(), seen[0]), long(seen.size())) << "step " << steps;
        was_symmetric = seen[0];
    }
    EXPECT_FALSE(was_symmetric);
    EXPECT_GE(steps, 2) << "the first step is the factor's";
}

} // namespace
} // namespace toile::test
