#include "core/pd/step/step_error.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "garment/energy/bending.h"
#include "garment/energy/membrane.h"
#include "research/linear/chebyshev_solver.h"
#include "research/linear/multigrid.h"
#include "tests/garment/sheets.h"

namespace toile::test {

using namespace garment;
using namespace research;

namespace {

constexpr double kDensity = 0.2; ///< [kg/m^2]

/// Sheet with two pinned corners and random velocities.
struct Thrown {
    double stiffness; ///< [N/m]
    double dt;        ///< [s]

    Sheet sheet = make_sheet(Vec2(1.0, 1.0), 24, 24, Pattern::Irregular);
    std::vector<Vec3> x = sheet.flat();
    std::vector<unsigned char> fixed = std::vector<unsigned char>(x.size(), 0);

    /// Positions at the end of a step.
    std::vector<Vec3> step(double tolerance, OuterMethod outer, std::unique_ptr<GlobalSolver> solver,
                           StepStop stop = StepStop::Error)
    {
        fixed[sheet.at(0, 0)] = fixed[sheet.at(24, 0)] = 1;
        const auto rest = sheet.rest();
        const std::vector<std::shared_ptr<Energy>> energies{
            std::make_shared<Membrane>(rest, Membrane::Settings{stiffness, stiffness, 0.2 * stiffness},
                                       "sheet"),
            std::make_shared<Bending>(rest, Bending::Settings{1e-5, 1e-5}, "sheet")};
        Body::Settings settings;
        settings.tolerance = tolerance;
        settings.max_iterations = 20000;
        settings.outer = outer;
        settings.stop = stop;
        Body body(x, std::make_unique<System>(masses_of(*rest, kDensity), energies, std::move(solver)),
                  settings);
        std::vector<Vec3> v;
        for (const Vec3& p : x)
            v.emplace_back(0.4 * std::sin(7.0 * p.z()), 1.5 * std::sin(5.0 * p.x() + 3.0 * p.z()), 0.0);
        body.set_velocities(v);
        const StepReport report =
            body.step(dt, std::vector<Vec3>(x.size(), Vec3(0.0, -9.81, 0.0)), fixed, x, nullptr, nullptr);
        EXPECT_EQ(report.status, StepReport::Status::Converged);
        return {body.positions().begin(), body.positions().end()};
    }
};

double rms(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double squares = 0.0;
    for (size_t i = 0; i < a.size(); ++i)
        squares += (a[i] - b[i]).squaredNorm();
    return std::sqrt(squares / double(a.size()));
}

TEST(StepError, ToleranceBoundsTheErrorForAnySolverMethodAndStiffness)
{
    constexpr double kTolerance = 1e-4;
    for (const auto& [stiffness, dt] :
         {std::pair(100.0, 1.0 / 120), {1000.0, 1.0 / 120}, {1000.0, 1.0 / 480}}) {
        Thrown thrown{stiffness, dt};
        const std::vector<Vec3> minimiser =
            thrown.step(1e-8, OuterMethod::NewtonPcg, std::make_unique<DirectSolver>());
        std::vector<double> errors;
        for (const OuterMethod outer : {OuterMethod::Lbfgs, OuterMethod::Anderson, OuterMethod::LocalGlobal})
            errors.push_back(
                rms(thrown.step(kTolerance, outer, std::make_unique<DirectSolver>()), minimiser));
        errors.push_back(
            rms(thrown.step(kTolerance, OuterMethod::Lbfgs, std::make_unique<Multigrid>()), minimiser));
        errors.push_back(
            rms(thrown.step(kTolerance, OuterMethod::Lbfgs, std::make_unique<ChebyshevSolver>()), minimiser));
        for (const double error : errors) {
            EXPECT_LT(error, 3.0 * kTolerance) << stiffness << ", " << dt;
            EXPECT_GT(error, 0.1 * kTolerance) << stiffness << ", " << dt;
        }
    }
}

/// Local/global iterations of stiff cloth have small displacements and large errors: only the error estimate
/// detects it.
TEST(StepError, StoppingByTheMoveLeavesLargerErrors)
{
    constexpr double kTolerance = 1e-4;
    Thrown thrown{1000.0, 1.0 / 120};
    const std::vector<Vec3> minimiser =
        thrown.step(1e-8, OuterMethod::NewtonPcg, std::make_unique<DirectSolver>());
    const auto error = [&](StepStop stop) {
        return rms(thrown.step(kTolerance, OuterMethod::LocalGlobal, std::make_unique<DirectSolver>(), stop),
                   minimiser);
    };
    EXPECT_LT(error(StepStop::Error), 3.0 * kTolerance);
    EXPECT_GT(error(StepStop::Move), 3.0 * kTolerance);
}

/// One vertex of 1 kg at the start of its fall, its weight still in the gradient.
TEST(StepError, UnsupportedWeightIsNotConverged)
{
    constexpr double kDt = 0.01, kWeight = 9.81;
    const std::vector<double> masses{1.0};
    const std::vector<Vec3> start{Vec3::Zero()}, prediction{Vec3(0.0, -kWeight * kDt * kDt, 0.0)};
    const std::vector<Vec3> tiny_move{Vec3(0.0, -1e-12, 0.0)};
    const std::vector<unsigned char> free{0}, pinned{1};
    for (const StepStop stop : {StepStop::Error, StepStop::Move}) {
        const auto is_within = [&](const std::vector<unsigned char>& fixed, double fraction) {
            const std::vector<Vec3> gradient{Vec3(0.0, fraction * kWeight, 0.0)};
            return StepError(masses, fixed, start, prediction, kDt)
                .is_within(1e-3, gradient, tiny_move, stop);
        };
        EXPECT_FALSE(is_within(free, 1.0));
        EXPECT_TRUE(is_within(free, 0.1));
        EXPECT_TRUE(is_within(pinned, 1.0));
    }
}

TEST(StepError, LongMovesWithLargeForcesAreNotConverged)
{
    const std::vector<double> masses{2.0};
    const std::vector<Vec3> here{Vec3::Zero()};
    const std::vector<unsigned char> free{0};
    const StepError error(masses, free, here, here, 0.1);
    const auto is_within = [&](double force, double move, StepStop stop = StepStop::Error) {
        return error.is_within(1e-3, std::vector<Vec3>{Vec3(force, 0.0, 0.0)},
                               std::vector<Vec3>{Vec3(move, 0.0, 0.0)}, stop);
    };
    // dt^2 f / m = 1e-2 m: the geometric mean with the move passes 1e-3 m at 1e-4 m.
    EXPECT_TRUE(is_within(2.0, 0.9e-4));
    EXPECT_FALSE(is_within(2.0, 1.1e-4));
    EXPECT_TRUE(is_within(2.0, 1.1e-4, StepStop::Move)) << "which does not ask";
}

} // namespace
} // namespace toile::test
