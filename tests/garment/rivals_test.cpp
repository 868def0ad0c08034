#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include <Eigen/Eigenvalues>

#include "core/backend/parallel.h"
#include "garment/rivals/colouring.h"
#include "garment/rivals/membrane_corner.h"
#include "garment/rivals/vertex_block_descent.h"
#include "tests/garment/sheets.h"

/// Methods by other people against our own on the same cloth.
namespace toile::test {
namespace {

/// A sheet, what drives it, and both kinds of simulators for it.
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
    /// Velocities that stretch, shear and fold the sheet.
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
        auto result = std::make_unique<Body>(
            x, std::make_unique<System>(cloth.masses, std::move(energies)), settings);
        result->set_velocities(v);
        return result;
    }

    std::unique_ptr<VertexBlockDescent> descent(const VertexBlockDescent::Settings& settings) const
    {
        auto result = std::make_unique<VertexBlockDescent>(x, cloth, settings);
        result->set_velocities(v);
        return result;
    }

    /// The objective of a step of dt [s] from here [J].
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

double farthest_apart(View<const Vec3> a, View<const Vec3> b)
{
    double farthest = 0.0;
    for (int i = 0; i < a.size(); ++i)
        farthest = std::max(farthest, (a[i] - b[i]).norm());
    return farthest;
}

std::vector<Vec3> copy(View<const Vec3> x) { return {x.begin(), x.end()}; }

TEST(ColourItems, GivesItemsWithACommonKeyDifferentColours)
{
    // Triangles of an irregular sheet by their vertices: at most a few more colours than triangles at a vertex.
    const auto rest = make_sheet(Vec2(1.0, 1.0), 20, 20, Pattern::Irregular).rest();
    Incidence keys;
    keys.first.push_back(0);
    for (const Triangle& t : rest->triangles) {
        keys.items.insert(keys.items.end(), t.begin(), t.end());
        keys.first.push_back(int(keys.items.size()));
    }
    const auto colours = colour_items(keys, rest->vertex_count());
    size_t items = 0;
    for (const std::vector<int>& colour : colours) {
        std::vector<int> seen(rest->vertex_count(), 0);
        for (const int t : colour)
            for (const int v : rest->triangles[t])
                EXPECT_EQ(seen[v]++, 0);
        items += colour.size();
    }
    EXPECT_EQ(items, rest->triangles.size());
    EXPECT_LE(colours.size(), 12u);
}

/// Gradient and Hessian block of corner 1 of a triangle at F + step g^T.
struct Corner {
    MembraneWeights weights{120.0, 80.0, 60.0};
    HatGradient<double> g{90.0, -40.0};
    double area = 5e-5;

    Vec3 gradient(const Mat32& F, Symmetric3<double>& hessian) const
    {
        Vec3 result = Vec3::Zero();
        add_membrane_corner<double>(F, g, area, weights, result, hessian);
        return result;
    }
    Mat3 hessian(const Mat32& F) const
    {
        Symmetric3<double> H(0.0);
        gradient(F, H);
        Mat3 full;
        full << H.xx, H.xy, H.xz, H.xy, H.yy, H.yz, H.xz, H.yz, H.zz;
        return full;
    }
    Mat3 hessian_by_differences(const Mat32& F) const
    {
        Mat3 result;
        const double step = 1e-7;
        for (int k = 0; k < 3; ++k) {
            Mat32 move = Mat32::Zero();
            move.row(k) << step * g.u, step * g.v;
            Symmetric3<double> ignored(0.0);
            result.col(k) = (gradient(F + move, ignored) - gradient(F - move, ignored)) / (2.0 * step);
        }
        return result;
    }
};

TEST(MembraneCorner, HasTheGradientOfTheMembrane)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> value(-1.5, 1.5);
    const Corner corner;
    Mat2 rest_inv;
    rest_inv << corner.g.u, corner.g.v, -20.0, 70.0;
    for (int trial = 0; trial < 50; ++trial) {
        Mat32 F;
        for (int k = 0; k < 6; ++k)
            F(k) = value(random);
        Symmetric3<double> hessian(0.0);
        const Vec3 expected =
            project_membrane<double>(F, rest_inv, corner.area, corner.weights).corner_gradient.col(0);
        EXPECT_LT((corner.gradient(F, hessian) - expected).norm(), 1e-12 * (1.0 + expected.norm()));
    }
}

TEST(MembraneCorner, HasTheHessianOfTheMembraneWhereItIsStretched)
{
    Mat32 F;
    for (const double shear : {0.0, 0.2, -0.3}) {
        F << 1.3, shear, 0.1, 1.4, 0.6 * shear, 0.2;
        const Mat3 exact = Corner().hessian_by_differences(F);
        EXPECT_LT((Corner().hessian(F) - exact).norm(), 1e-6 * exact.norm());
    }
}

TEST(MembraneCorner, IsPositiveAndBoundsTheHessianWhereItIsCompressed)
{
    std::mt19937 random(6);
    std::uniform_real_distribution<double> value(-1.2, 1.2);
    for (int trial = 0; trial < 200; ++trial) {
        Mat32 F;
        for (int k = 0; k < 6; ++k)
            F(k) = value(random);
        const Mat3 projected = Corner().hessian(F), exact = Corner().hessian_by_differences(F);
        const double size = projected.norm();
        const auto least = [](const Mat3& A) {
            return Eigen::SelfAdjointEigenSolver<Mat3>(Mat3(0.5 * (A + A.transpose()))).eigenvalues()[0];
        };
        EXPECT_GT(least(projected), -1e-9 * size);
        EXPECT_GT(least(projected - exact), -1e-4 * size) << "clamping only adds";
    }
}

TEST(Symmetric3, SolvesWithItsInverse)
{
    Symmetric3<double> A(0.1);
    A.add_square(2.0, Vec3(1.0, -2.0, 0.5));
    A.add_square(3.0, Vec3(0.0, 1.0, 1.0));
    Mat3 full;
    full << A.xx, A.xy, A.xz, A.xy, A.yy, A.yz, A.xz, A.yz, A.zz;
    const Vec3 b(1.0, 2.0, -3.0);
    EXPECT_LT((full * A.solve(b) - b).norm(), 1e-12);
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
        for (const auto start : {VertexBlockDescent::Start::Prediction, VertexBlockDescent::Start::Adaptive}) {
            VertexBlockDescent::Settings settings;
            settings.max_sweeps = 20000;
            settings.tolerance = 1e-10;
            settings.rho = rho;
            settings.start = start;
            const auto descent = trial.descent(settings);
            const StepReport report = descent->step(dt, trial.acceleration, trial.fixed, trial.x);
            EXPECT_EQ(report.status, StepReport::Status::Converged);
            EXPECT_LT(farthest_apart(descent->positions(), body->positions()), 1e-7);
            EXPECT_LT(farthest_apart(descent->velocities(), body->velocities()), 1e-5);
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
        for (int k = 0; k < 3; ++k)
            (void)descent->step(1.0 / 120.0, trial.acceleration, trial.fixed, trial.x);
        if (first.empty())
            first = copy(descent->positions());
        EXPECT_EQ(copy(descent->positions()), first);
    }
}

} // namespace
} // namespace toile::test
