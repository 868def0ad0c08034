#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include <Eigen/LU>
#include <Eigen/SVD>

#include "core/pd/minimiser/newton_direct.h"
#include "garment/energy/bending.h"
#include "garment/energy/membrane.h"
#include "garment/energy/springs.h"
#include "tests/garment/newton.h"
#include "tests/garment/sheets.h"
#include "tests/garment/touching_plane.h"

/// Body::step compared with an independent Newton method that minimises the same implicit Euler objective
/// from the same prediction.
namespace toile::test {

using namespace collision;
using namespace garment;

namespace {

constexpr Membrane::Settings kOrthotropic{300.0, 120.0, 20.0};

/// Membrane implemented from its definition: singular values instead of closed-form projections.
class MembraneBySvd : public Energy {
public:
    MembraneBySvd(std::shared_ptr<const RestShape> rest, const Membrane::Settings& s)
        : rest_(std::move(rest)), settings_(s)
    {
    }
    std::string_view name() const override { return "test/membrane"; }
    void add_hessian(Triplets&) const override {}

    double add_gradient(View<const Vec3> x, View<Vec3> gradient) override
    {
        double value = 0.0;
        for (size_t t = 0; t < rest_->triangles.size(); ++t) {
            const Triangle& corner = rest_->triangles[t];
            const Mat2 to_material = rest_->edges[t].inverse();
            Mat32 edges;
            edges << x[corner[1]] - x[corner[0]], x[corner[2]] - x[corner[0]];
            Mat32 stress;
            value += rest_->areas[t] * density(edges * to_material, stress);
            const Mat32 force = rest_->areas[t] * stress * to_material.transpose();
            gradient[corner[1]] += force.col(0);
            gradient[corner[2]] += force.col(1);
            gradient[corner[0]] -= force.col(0) + force.col(1);
        }
        return value;
    }

private:
    /// Energy per area [J/m^2] and its derivative by F [N/m].
    double density(const Mat32& F, Mat32& stress) const
    {
        const double G = settings_.shear;
        const Eigen::JacobiSVD<Eigen::MatrixXd> svd(F, Eigen::ComputeThinU | Eigen::ComputeThinV);
        const Vec2 excess = svd.singularValues() - Vec2::Ones();
        double value = G * excess.squaredNorm();
        stress = 2.0 * G * svd.matrixU() * excess.asDiagonal() * svd.matrixV().transpose();
        const Vec2 yarn(settings_.warp - 2.0 * G, settings_.weft - 2.0 * G);
        for (int k = 0; k < 2; ++k) {
            const double length = F.col(k).norm();
            value += 0.5 * yarn[k] * (length - 1.0) * (length - 1.0);
            stress.col(k) += yarn[k] * (length - 1.0) * F.col(k) / length;
        }
        return value;
    }

    std::shared_ptr<const RestShape> rest_;
    Membrane::Settings settings_;
};

/// One step of a small sheet, by the library and by Newton.
struct OneStep {
    Sheet sheet = make_sheet(Vec2(0.21, 0.18), 7, 6, Pattern::Irregular);
    std::shared_ptr<const RestShape> rest = sheet.rest();
    std::vector<double> masses = masses_of(*rest, 0.2);
    std::vector<std::shared_ptr<Energy>> energies{std::make_shared<Membrane>(rest, kOrthotropic, "sheet")};
    std::vector<std::shared_ptr<Energy>> oracle{std::make_shared<MembraneBySvd>(rest, kOrthotropic)};
    ActiveSetEnergy* active = nullptr;
    double dt = 1.0 / 120.0;
    std::vector<Vec3> x = sheet.flat(), v, gravity;
    std::vector<unsigned char> fixed;

    OneStep()
    {
        v.assign(x.size(), Vec3::Zero());
        gravity.assign(x.size(), Vec3(0.0, -9.81, 0.0));
        fixed.assign(x.size(), 0);
    }
    void add(const std::shared_ptr<Energy>& energy)
    {
        energies.push_back(energy);
        oracle.push_back(energy);
    }
    void add_bending(double rigidity)
    {
        add(std::make_shared<Bending>(rest, Bending::Settings{rigidity, 0.4 * rigidity}, "sheet"));
    }
    /// Adds velocities that stretch, shear and fold the sheet.
    void stir(double speed)
    {
        for (size_t i = 0; i < x.size(); ++i)
            v[i] = speed * Vec3(std::sin(30.0 * x[i].z() + 1.0), std::cos(25.0 * x[i].x() + 20.0 * x[i].z()),
                                std::cos(35.0 * x[i].x()));
    }

    std::vector<Vec3> by_body(OuterMethod outer,
                              ContactPreconditioner preconditioner = ContactPreconditioner::Block) const
    {
        Body::Settings settings;
        settings.contact_solve.preconditioner = preconditioner;
        settings.outer = outer;
        settings.tolerance = 1e-12;
        settings.max_iterations = 20000;
        settings.contact_solve.pcg = {1e-10, 500};
        Body body(x, std::make_unique<System>(masses, energies), settings);
        body.set_velocities(v);
        const StepReport report = body.step(dt, gravity, fixed, x, active, nullptr);
        EXPECT_LT(report.displacement, 1e-9);
        return {body.positions().begin(), body.positions().end()};
    }

    /// Prediction q* of implicit Euler.
    std::vector<Vec3> predicted() const
    {
        std::vector<Vec3> prediction = x;
        for (size_t i = 0; i < x.size(); ++i)
            if (!fixed[i])
                prediction[i] += dt * v[i] + dt * dt * gravity[i];
        return prediction;
    }

    /// Result of the library's Newton method with a direct solver, without contact.
    std::vector<Vec3> by_newton_direct() const
    {
        System system(masses, energies);
        system.prepare(dt, fixed);
        const std::vector<Vec3> prediction = predicted();
        StepObjective objective(
            system, {x, prediction, system.diagonal(), system.fixed(), system.masses(), dt}, nullptr);
        std::vector<Vec3> solution = prediction;
        NewtonDirect newton;
        const OuterLoop::Outcome outcome = newton.minimise(objective, solution, {1e-11, 100});
        EXPECT_TRUE(outcome.converged);
        EXPECT_LT(outcome.iterations, 30);
        EXPECT_LT(newton.decrement(), 1e-15);
        return solution;
    }

    std::vector<Vec3> by_newton() const
    {
        const std::vector<Vec3> prediction = predicted();
        const auto objective = [&](const std::vector<Vec3>& at, std::vector<Vec3>& gradient) {
            double value = 0.0;
            for (size_t i = 0; i < at.size(); ++i) {
                const Vec3 from = at[i] - prediction[i];
                gradient[i] = masses[i] / (dt * dt) * from;
                value += 0.5 * masses[i] / (dt * dt) * from.squaredNorm();
            }
            for (const auto& energy : oracle)
                value += energy->add_gradient(at, gradient);
            return active ? value + active->add_gradient(at, gradient) : value;
        };
        std::vector<Vec3> solution = prediction;
        EXPECT_LT(minimise_by_newton(objective, fixed, solution), 1e-11);
        return solution;
    }

    /// Compares the ends of the step; the forces must have moved some vertex by `min_correction` [m].
    /// @return result of Newton's method
    std::vector<Vec3> expect_agreement(double min_correction) const
    {
        std::vector<Vec3> oracle_end = by_newton();
        // Each ends at the tolerance of its own criterion.
        for (const OuterMethod outer : {OuterMethod::Lbfgs, OuterMethod::Anderson, OuterMethod::NewtonPcg})
            EXPECT_LT(max_distance(by_body(outer), oracle_end), 2e-8) << "method " << int(outer);
        if (!active) {
            EXPECT_LT(max_distance(by_newton_direct(), oracle_end), 1e-8);
        }
        std::vector<Vec3> free = x;
        for (size_t i = 0; i < x.size(); ++i)
            free[i] += dt * (v[i] + dt * gravity[i]);
        EXPECT_GT(max_distance(free, oracle_end), min_correction);
        return oracle_end;
    }

    static double max_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
    {
        double largest = 0.0;
        for (size_t i = 0; i < a.size(); ++i)
            largest = std::max(largest, (a[i] - b[i]).norm());
        return largest;
    }
};

TEST(OneStep, AgreesWithNewtonOnAMembrane)
{
    OneStep step;
    step.stir(0.5);
    step.expect_agreement(1e-3);
}

TEST(OneStep, AgreesWithNewtonWithBendingAndFixedVertices)
{
    OneStep step;
    step.add_bending(5e-4);
    step.fixed[step.sheet.at(0, 0)] = step.fixed[step.sheet.at(7, 0)] = 1;
    step.stir(0.5);
    step.expect_agreement(1e-3);
}

TEST(OneStep, AgreesWithNewtonWithSprings)
{
    OneStep step;
    step.add_bending(1e-4);
    const auto springs = std::make_shared<Springs>(
        std::vector<Springs::Spring>{{step.sheet.at(0, 6), 50.0}, {step.sheet.at(3, 3), 5.0}});
    springs->hold(0, Vec3(-0.02, 0.01, 0.2));
    springs->hold(1, Vec3(0.1, 0.05, 0.1));
    step.add(springs);
    step.expect_agreement(1e-3);
}

TEST(OneStep, AgreesWithNewtonUnderLargeDeformation)
{
    // Stretched to more than twice its length along the warp, sheared and folded, at a long time step.
    OneStep step;
    step.add_bending(1e-3);
    step.dt = 1.0 / 30.0;
    for (int row = 0; row <= 6; ++row)
        step.fixed[step.sheet.at(0, row)] = step.fixed[step.sheet.at(7, row)] = 1;
    for (Vec3& p : step.x)
        p = Vec3(2.2 * p.x() + 0.6 * p.z(), 0.05 * std::sin(20.0 * p.z()), 1.1 * p.z());
    step.stir(0.3);
    step.expect_agreement(5e-3);
}

TEST(OneStep, AgreesWithNewtonInContactWithoutFriction)
{
    OneStep step;
    step.add_bending(2e-4);
    TouchingPlane plane(step.x, {Vec3(0.1, 1.0, 0.2).normalized(), 0.03, 800.0, 0.0, 0.0});
    step.active = &plane;
    step.stir(0.5);
    const int pressing = plane.pressing(step.expect_agreement(1e-3));
    EXPECT_GT(pressing, 14);
    EXPECT_LT(pressing, 42) << "some of the 56 vertices press, some hover";
}

TEST(OneStep, AgreesWithNewtonInContactWithFriction)
{
    // A friction limit at which some vertices slide and some stick.
    OneStep step;
    step.add_bending(2e-4);
    TouchingPlane plane(step.x, {Vec3(0.1, 1.0, 0.2).normalized(), 0.03, 800.0, 0.4, 0.1});
    step.active = &plane;
    step.stir(0.5);
    const std::vector<Vec3> solution = step.expect_agreement(1e-3);
    EXPECT_GT(plane.sliding(solution), 5);
    EXPECT_GT(plane.pressing(solution) - plane.sliding(solution), 5);
}

TEST(OneStep, AgreesWithNewtonForAnyPreconditionerOfContact)
{
    // The centres of all triangles press on the plane: terms of three vertices that share them.
    OneStep step;
    step.add_bending(2e-4);
    std::vector<ContactTerm> terms;
    for (const Triangle& t : step.sheet.triangles) {
        ContactTerm& term = terms.emplace_back();
        term.pair.vertex = contact_vertices(t[0], t[1], t[2]);
        term.pair.weight = {0.5, 0.3, 0.2};
        term.pair.normal = Vec3(0.1, 1.0, 0.2).normalized();
        term.pair.point = 0.03 * term.pair.normal;
        term.spring.stiffness = 800.0;
    }
    TouchingPlane plane(std::move(terms), int(step.x.size()));
    step.active = &plane;
    step.stir(0.5);
    const std::vector<Vec3> oracle = step.by_newton();
    for (const auto which : {ContactPreconditioner::Block, ContactPreconditioner::Exact,
                             ContactPreconditioner::ShermanMorrison, ContactPreconditioner::Chebyshev})
        EXPECT_LT(OneStep::max_distance(step.by_body(OuterMethod::Lbfgs, which), oracle), 1e-8)
            << "preconditioner " << int(which);
}

} // namespace
} // namespace toile::test
