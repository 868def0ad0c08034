#include "core/quadrature/solve_costs.h"

#include <gtest/gtest.h>

#include "core/linear/direct_solver.h"
#include "core/quadrature/tables/table_store.h"
#include "tests/core/quadrature/quadrature_problems.h"

namespace toile::test {

namespace {

TEST(SolveCosts, ExpectTheMeasuredListLengths)
{
    EXPECT_NEAR(expected_gathers(2500), 124.0, 3.0);
    EXPECT_NEAR(expected_gathers(10000), 168.0, 3.0);
    EXPECT_NEAR(expected_gathers(50176), 236.0, 3.0);
}

TEST(SolveCosts, AreNotCountedInTheStagesOfTheRun)
{
    const Grid grid;
    DirectSolver direct;
    direct.update(grid.matrix(1e-3), grid.fixed);
    Stages stages;
    const Stages::Activate activate(stages);
    const SolveCosts expected = expected_costs(*direct.factor());
    EXPECT_GT(expected.direct, 0.0);
    EXPECT_GT(expected.quadrature, 0.0);
    EXPECT_GT(expected.build, expected.direct);
    const SolveCosts measured =
        measured_costs(*direct.factor(), QuadratureOperator(std::make_shared<TableStore>()->get(
                                             {grid.matrix(1e-3), grid.fixed, grid.points, {}})));
    EXPECT_GT(measured.quadrature, 0.0);
    EXPECT_EQ(stages.calls("linear/solve") + stages.calls("quadrature/solve"), 0);
}

} // namespace
} // namespace toile::test
