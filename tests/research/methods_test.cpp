#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <Eigen/Geometry>

#include "core/base/error.h"
#include "core/compute/parallel.h"
#include "garment/energy/membrane.h"
#include "research/methods/vbd/vertex_block_descent.h"
#include "research/methods/xpbd/xpbd.h"
#include "tests/garment/sheets.h"

/// Baseline methods compared with ours on the same cloth.
namespace toile::test {

using namespace garment;
using namespace research;

namespace {

/// A sheet, its loads, and both kinds of simulators for it.
struct Trial {
    Sheet sheet;
    ClothModel cloth;
    std::vector<Vec3> x, v, acceleration;
    std::vector<unsigned char> fixed;

    explicit Trial(const Sheet& shape) : sheet(shape)
    {
        cloth.rest = sheet.rest();
        cloth.masses = masses_of(*cloth.rest, 0.2);
        cloth.stretch = {300.0, 120.0, 20.0};
        cloth.bending = {5e-4, 2e-4};
        x = sheet.flat();
        v.assign(x.size(), Vec3::Zero());
        acceleration.assign(x.size(), Vec3(0.0, -9.81, 0.0));
        fixed.assign(x.size(), 0);
    }
    /// Adds velocities that stretch, shear and fold the sheet.
    void stir(double speed)
    {
        for (size_t i = 0; i < x.size(); ++i)
            v[i] = speed * Vec3(std::sin(30.0 * x[i].z() + 1.0), std::cos(25.0 * x[i].x() + 20.0 * x[i].z()),
                                std::cos(35.0 * x[i].x()));
    }

    std::unique_ptr<Body> body(double tolerance, int max_iterations) const
    {
        std::vector<std::shared_ptr<Energy>> energies{
            std::make_shared<Membrane>(cloth.rest, cloth.stretch, "sheet"),
            std::make_shared<Bending>(cloth.rest, cloth.bending, "sheet")};
        Body::Settings settings;
        settings.tolerance = tolerance;
        settings.max_iterations = max_iterations;
        auto result =
            std::make_unique<Body>(x, std::make_unique<System>(cloth.masses, std::move(energies)), settings);
        result->set_velocities(v);
        return result;
    }

    std::unique_ptr<VertexBlockDescent> descent(const VertexBlockDescent::Settings& settings) const
    {
        auto result = std::make_unique<VertexBlockDescent>(x, cloth, settings);
        result->set_velocities(v);
        return result;
    }

    std::unique_ptr<Xpbd> xpbd(const Xpbd::Settings& settings) const
    {
        auto result = std::make_unique<Xpbd>(x, cloth, settings);
        result->set_velocities(v);
        return result;
    }

    /// Positions after `steps` steps of dt [s].
    std::vector<Vec3> run(BaselineMethod& baseline, double dt, int steps) const
    {
        for (int k = 0; k < steps; ++k)
            EXPECT_NE(baseline.step(dt, acceleration, fixed, x).status, StepReport::Status::NonFinite);
        return {baseline.positions().begin(), baseline.positions().end()};
    }

    /// Objective of a step of dt [s] from the current state [J].
    double objective(View<const Vec3> at, double dt) const
    {
        std::vector<Vec3> ignored(x.size(), Vec3::Zero());
        double value = Membrane(cloth.rest, cloth.stretch, "sheet").add_gradient(at, ignored) +
                       Bending(cloth.rest, cloth.bending, "sheet").add_gradient(at, ignored);
        for (size_t i = 0; i < x.size(); ++i) {
            const Vec3 from = at[int(i)] - x[i] - dt * v[i] - dt * dt * acceleration[i];
            value += fixed[i] ? 0.0 : 0.5 * cloth.masses[i] / (dt * dt) * from.squaredNorm();
        }
        return value;
    }
};

double max_distance(View<const Vec3> a, View<const Vec3> b)
{
    double max = 0.0;
    for (int i = 0; i < a.size(); ++i)
        max = std::max(max, (a[i] - b[i]).norm());
    return max;
}

TEST(VertexBlockDescent, FindsTheMinimiserOfBody)
{
    const double dt = 1.0 / 120.0;
    for (const double rho : {0.0, 0.95}) {
        Trial trial(make_sheet(Vec2(0.21, 0.18), 7, 6, Pattern::Irregular));
        trial.fixed[trial.sheet.at(0, 0)] = trial.fixed[trial.sheet.at(7, 0)] = 1;
        trial.stir(0.5);
        const auto body = trial.body(1e-12, 20000);
        (void)body->step(dt, trial.acceleration, trial.fixed, trial.x, nullptr, nullptr);
        for (const auto start :
             {VertexBlockDescent::Start::Prediction, VertexBlockDescent::Start::Adaptive}) {
            VertexBlockDescent::Settings settings;
            settings.max_sweeps = 20000;
            settings.tolerance = 1e-10;
            settings.rho = rho;
            settings.start = start;
            const auto descent = trial.descent(settings);
            const StepReport report = descent->step(dt, trial.acceleration, trial.fixed, trial.x);
            EXPECT_EQ(report.status, StepReport::Status::Converged);
            EXPECT_LT(max_distance(descent->positions(), body->positions()), 1e-7);
            EXPECT_LT(max_distance(descent->velocities(), body->velocities()), 1e-5);
        }
    }
}

TEST(VertexBlockDescent, LowersTheObjectiveInEverySweep)
{
    for (const double speed : {0.5, 2.0, 8.0}) {
        Trial trial(make_sheet(Vec2(0.3, 0.3), 10, 10, Pattern::Irregular));
        trial.fixed[trial.sheet.at(0, 0)] = 1;
        trial.stir(speed);
        double last = INFINITY;
        for (int sweeps = 0; sweeps <= 40; ++sweeps) {
            const auto descent = trial.descent({sweeps, 0.0, 0.0, VertexBlockDescent::Start::Prediction});
            (void)descent->step(1.0 / 60.0, trial.acceleration, trial.fixed, trial.x);
            const double value = trial.objective(descent->positions(), 1.0 / 60.0);
            EXPECT_LT(value, last) << "sweep " << sweeps << " at " << speed << " m/s";
            last = value;
        }
    }
}

TEST(VertexBlockDescent, GivesTheSameBitsOnAnyNumberOfThreads)
{
    Trial trial(make_sheet(Vec2(0.5, 0.5), 40, 40, Pattern::Irregular));
    trial.fixed[trial.sheet.at(0, 0)] = 1;
    trial.stir(0.5);
    std::vector<Vec3> first;
    for (const int threads : {1, 2, 4}) {
        const ThreadLimit limit(threads);
        const auto descent = trial.descent({20, 0.0, 0.9});
        const std::vector<Vec3> x = trial.run(*descent, 1.0 / 120.0, 3);
        if (first.empty())
            first = x;
        EXPECT_EQ(x, first);
    }
}

TEST(VertexBlockDescent, StartsWithTheAccelerationOfTheLastStep)
{
    // Free fall: the full acceleration from the second step on, without sweeps.
    Trial trial(make_sheet(Vec2(0.2, 0.2), 4, 4));
    const auto falling = trial.descent({0, 0.0, 0.0, VertexBlockDescent::Start::Adaptive});
    std::vector<Vec3> v(trial.x.size(), Vec3(0.0, -0.0981, 0.0));
    falling->set_velocities(v);
    const std::vector<Vec3> fallen = trial.run(*falling, 0.01, 1);
    EXPECT_NEAR(fallen[0].y(), -2.0 * 0.000981, 1e-15);

    // At rest: no acceleration.
    const auto resting = trial.descent({0, 0.0, 0.0, VertexBlockDescent::Start::Adaptive});
    EXPECT_EQ(trial.run(*resting, 0.01, 1), trial.x);
}

/// Sheet that falls from the horizontal, fixed at two corners.
Trial hanging()
{
    Trial trial(make_sheet(Vec2(0.3, 0.3), 8, 8, Pattern::Irregular));
    trial.cloth.bending = {1e-5, 1e-5};
    trial.fixed[trial.sheet.at(0, 0)] = trial.fixed[trial.sheet.at(8, 0)] = 1;
    return trial;
}

TEST(Xpbd, ConvergesToTheMotionOfBody)
{
    const Trial trial = hanging();
    const double dt = 1.0 / 120.0;
    const int steps = 12, parts = 64;
    const auto body = trial.body(1e-10, 5000);
    for (int k = 0; k < steps * parts; ++k)
        (void)body->step(dt / parts, trial.acceleration, trial.fixed, trial.x, nullptr, nullptr);
    for (const bool by_forces : {true, false}) {
        double last = 1.0;
        for (const int substeps : {2, 8, 32, 128}) {
            const auto xpbd = trial.xpbd({substeps, by_forces});
            const double apart = max_distance(trial.run(*xpbd, dt, steps), body->positions());
            EXPECT_LT(apart, 0.5 * last) << substeps << " substeps";
            last = apart;
        }
        EXPECT_LT(last, 2e-4);
    }
}

TEST(Xpbd, StretchesAHangingStripByItsWeight)
{
    // rho_A g L^2 / (2 Y), as in hanging_test.cpp. Damping is refreshed every substep: kept over many, it
    // excites the fast modes.
    const double areal_density = 0.2, gravity = 9.81;
    for (const double strain : {0.005, 0.1}) {
        Trial trial(make_sheet(Vec2(1.0, 0.2), 20, 4, Pattern::Irregular));
        const double Y = areal_density * gravity / (2.0 * strain);
        trial.cloth.stretch = {Y, 0.8 * Y, 0.3 * Y};
        trial.cloth.bending = {0.0, 0.0};
        for (size_t i = 0; i < trial.x.size(); ++i)
            trial.x[i] = Vec3(trial.sheet.uv[i].y(), -trial.sheet.uv[i].x(), 0.0);
        for (int row = 0; row <= 4; ++row)
            trial.fixed[trial.sheet.at(0, row)] = 1;
        const auto strip = trial.xpbd({1});
        for (int k = 0; k < 12000; ++k) {
            for (size_t i = 0; i < trial.x.size(); ++i)
                trial.acceleration[i] = Vec3(0.0, -gravity, 0.0) - 8.0 * strip->velocities()[int(i)];
            (void)strip->step(1.0 / 4800.0, trial.acceleration, trial.fixed, trial.x);
        }
        double sum = 0.0;
        for (int row = 0; row <= 4; ++row)
            sum += -strip->positions()[trial.sheet.at(20, row)].y() - 1.0;
        EXPECT_NEAR(sum / 5.0 / strain, 1.0, 0.01) << "strain " << strain;
    }
}

TEST(Xpbd, BendsByForcesAndByConstraintsAlike)
{
    // One short substep from a crumpled sheet: both displace it by h^2 K x / m.
    Trial trial(make_sheet(Vec2(0.2, 0.2), 6, 6, Pattern::Irregular));
    for (Vec3& p : trial.x)
        p.y() = 0.02 * std::sin(40.0 * p.x()) * std::cos(50.0 * p.z());
    const double h = 1e-5;
    const std::vector<Vec3> by_forces = trial.run(*trial.xpbd({1, true}), h, 1);
    const std::vector<Vec3> by_constraints = trial.run(*trial.xpbd({1, false}), h, 1);
    trial.cloth.bending = {0.0, 0.0};
    const std::vector<Vec3> unbent = trial.run(*trial.xpbd({1}), h, 1);
    EXPECT_LT(max_distance(by_forces, by_constraints), 1e-3 * max_distance(by_forces, unbent));
}

TEST(Xpbd, RefusesLessThanOneSubstep) { EXPECT_THROW(hanging().xpbd({0}), InvalidInput); }

TEST(Xpbd, KeepsFixedVertices)
{
    Trial trial = hanging();
    trial.stir(1.0);
    const auto xpbd = trial.xpbd({10});
    std::vector<Vec3> targets = trial.x;
    for (int k = 0; k < 5; ++k) {
        for (Vec3& p : targets)
            p += Vec3(0.001, 0.002, 0.0);
        (void)xpbd->step(0.01, trial.acceleration, trial.fixed, targets);
        const int corner = trial.sheet.at(8, 0);
        EXPECT_EQ(xpbd->positions()[corner], targets[corner]);
        EXPECT_LT((xpbd->velocities()[corner] - Vec3(0.1, 0.2, 0.0)).norm(), 1e-10);
    }
}

TEST(Xpbd, KeepsMomentumInFreeFlight)
{
    for (const bool by_forces : {true, false}) {
        Trial trial(make_sheet(Vec2(0.3, 0.3), 8, 8, Pattern::Irregular));
        trial.stir(1.0);
        const auto momenta = [&](View<const Vec3> x, View<const Vec3> v) {
            std::pair<Vec3, Vec3> result(Vec3::Zero(), Vec3::Zero());
            for (int i = 0; i < x.size(); ++i) {
                result.first += trial.cloth.masses[i] * v[i];
                result.second += trial.cloth.masses[i] * x[i].cross(v[i]);
            }
            return result;
        };
        trial.acceleration.assign(trial.x.size(), Vec3::Zero());
        const auto [linear, angular] = momenta(trial.x, trial.v);
        const auto xpbd = trial.xpbd({20, by_forces});
        (void)trial.run(*xpbd, 0.01, 20);
        const auto [linear_t1, angular_t1] = momenta(xpbd->positions(), xpbd->velocities());
        EXPECT_LT((linear_t1 - linear).norm(), 1e-11 * linear.norm());
        EXPECT_LT((angular_t1 - angular).norm(), 5e-3 * angular.norm());
    }
}

TEST(Xpbd, GivesTheSameBitsOnAnyNumberOfThreads)
{
    Trial trial(make_sheet(Vec2(0.5, 0.5), 60, 60, Pattern::Irregular));
    trial.fixed[trial.sheet.at(0, 0)] = 1;
    trial.stir(0.5);
    for (const bool by_forces : {true, false}) {
        std::vector<Vec3> first;
        for (const int threads : {1, 2, 4}) {
            const ThreadLimit limit(threads);
            const std::vector<Vec3> x = trial.run(*trial.xpbd({10, by_forces}), 1.0 / 120.0, 3);
            if (first.empty())
                first = x;
            EXPECT_EQ(x, first);
        }
    }
}

} // namespace
} // namespace toile::test
