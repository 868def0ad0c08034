#include "core/pd/rigid/rigid_bodies.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include "core/base/error.h"
#include "core/mesh/solid_moments.h"
#include "core/pd/rigid/rigid_active_set.h"
#include "core/pd/step/body.h"

namespace toile::test {

namespace {

/// Closed, rotated box of 8 vertices about a point.
TriangleMesh box_of(const Vec3& size, const Vec3& centre = Vec3::Zero(), const Mat3& R = Mat3::Identity())
{
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i) {
        const Vec3 corner((i & 1) - 0.5, (i >> 1 & 1) - 0.5, (i >> 2 & 1) - 0.5);
        mesh.positions.push_back(centre + R * corner.cwiseProduct(size));
    }
    const int quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                             {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& q : quads) {
        mesh.triangles.emplace_back(q[0], q[1], q[2]);
        mesh.triangles.emplace_back(q[0], q[2], q[3]);
    }
    return mesh;
}

const Mat3 kTilt = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();

TEST(SolidMoments, MatchABox)
{
    const Vec3 size(0.2, 0.3, 0.5), centre(4.0, -2.0, 1.0);
    const SolidMoments moments = solid_moments(box_of(size, centre, kTilt), "box");
    const Mat3 exact = size.prod() / 12.0 * kTilt * size.cwiseAbs2().asDiagonal() * kTilt.transpose();
    EXPECT_NEAR(moments.volume, size.prod(), 1e-15);
    EXPECT_LT((moments.centre - centre).norm(), 1e-14);
    EXPECT_LT((moments.second - exact).norm(), 1e-16);
}

TEST(SolidMoments, DistinguishOpenFromInsideOut)
{
    TriangleMesh open = box_of(Vec3::Ones());
    open.triangles.pop_back();
    EXPECT_THROW(solid_moments(open, "box"), InvalidInput);
    TriangleMesh inverted = box_of(Vec3::Ones());
    for (Triangle& t : inverted.triangles)
        std::swap(t[0], t[1]);
    EXPECT_THROW(solid_moments(inverted, "box"), InvalidInput);
}

TEST(RigidShape, HasTheInertiaOfABox)
{
    const Vec3 size(0.2, 0.3, 0.5);
    const RigidShape shape = rigid_shape_of(box_of(size, Vec3(1, 2, 3), kTilt), 800.0, "box");
    const double m = 800.0 * size.prod();
    const Mat3 inertia = m * shape.axes * shape.gyration.cwiseAbs2().asDiagonal() * shape.axes.transpose();
    const Vec3 s2 = size.cwiseAbs2();
    const Mat3 exact = m / 12.0 * kTilt * Vec3(s2.sum() - s2.array()).asDiagonal() * kTilt.transpose();
    EXPECT_NEAR(shape.mass, m, 1e-12);
    EXPECT_LT((inertia - exact).norm(), 1e-13);
}

/// Bodies in free flight: their unknowns in a Body, without contact.
struct Flight {
    RigidBodies bodies;
    Body body;

    explicit Flight(std::vector<RigidShape> shapes)
        : bodies(std::move(shapes)),
          body(std::vector<Vec3>(bodies.unknown_count(), Vec3::Zero()),
               std::make_unique<System>(bodies.masses(), std::vector<std::shared_ptr<Energy>>()), {})
    {
    }

    int step(double dt, const Vec3& gravity)
    {
        const int n = bodies.unknown_count();
        std::vector<Vec3> q(n), v(n), acceleration(n, Vec3::Zero());
        for (int i = 0; i < bodies.count(); ++i)
            acceleration[2 * i] = gravity;
        bodies.begin_step(dt, q, v);
        body.set_positions(q);
        body.set_velocities(v);
        const StepReport report =
            body.step(dt, acceleration, std::vector<unsigned char>(n, 0), q, nullptr, nullptr);
        bodies.end_step(body.positions(), body.velocities());
        return report.iterations;
    }
};

/// Angular velocity of a body in the body frame by Euler's equations, with classical Runge-Kutta in small
/// steps.
Vec3 euler_rate(Vec3 rate, const Vec3& moments, double time)
{
    const int steps = 20000;
    const double h = time / steps;
    const auto change = [&](const Vec3& w) {
        return Vec3(-w.cross(moments.cwiseProduct(w)).cwiseQuotient(moments));
    };
    for (int i = 0; i < steps; ++i) {
        const Vec3 a = change(rate), b = change(rate + 0.5 * h * a), c = change(rate + 0.5 * h * b),
                   d = change(rate + h * c);
        rate += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    }
    return rate;
}

/// Angular velocity in the body frame after `time` seconds of flight in steps of dt.
Vec3 flown_rate(double dt, double time, const Vec3& rate, double* momentum_error)
{
    Flight flight({rigid_shape_of(box_of(Vec3(0.1, 0.2, 0.3)), 500.0, "box")});
    flight.bodies.set_velocity(0, Vec3(1, 2, 3), rate);
    const Vec3 spin = flight.bodies.angular_momentum(0);
    for (int i = 0; i < int(std::lround(time / dt)); ++i)
        EXPECT_EQ(flight.step(dt, Vec3::Zero()), 0);
    *momentum_error = (flight.bodies.angular_momentum(0) - spin).norm() / spin.norm();
    EXPECT_LT((flight.bodies.centre(0) - time * Vec3(1, 2, 3)).norm(), 1e-11);
    const RigidShape& shape = flight.bodies.shape(0);
    // In the box's axes: shape.axes are those of the start, which were the world's.
    return shape.axes * (flight.bodies.rotation(0).transpose() * flight.bodies.angular_momentum(0))
                            .cwiseQuotient(shape.mass * shape.gyration.cwiseAbs2());
}

TEST(RigidBodies, TumbleByEulersEquations)
{
    const Vec3 rate(0.1, 6.0, 0.2); // about the middle axis: unstable, it flips
    const double m = 500.0 * 0.006;
    const Vec3 moments = m / 12.0 * Vec3(0.04 + 0.09, 0.01 + 0.09, 0.01 + 0.04);
    const double time = 2.0;
    const Vec3 exact = euler_rate(rate, moments, time);
    ASSERT_GT((exact - rate).norm(), 3.0);

    double momentum_error = 1.0;
    const double coarse = (flown_rate(0.004, time, rate, &momentum_error) - exact).norm();
    EXPECT_LT(momentum_error, 1e-12);
    const double fine = (flown_rate(0.002, time, rate, &momentum_error) - exact).norm();
    EXPECT_LT(fine, 0.01 * exact.norm());
    EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.2); // second order
}

TEST(RigidBodies, FallAsImplicitEulerDoes)
{
    Flight flight({rigid_shape_of(box_of(Vec3(0.1, 0.2, 0.3), Vec3(0, 1, 0)), 500.0, "box")});
    const double dt = 0.01;
    const int n = 50;
    for (int i = 0; i < n; ++i)
        flight.step(dt, Vec3(0, -9.81, 0));
    EXPECT_NEAR(flight.bodies.centre(0).y(), 1.0 - 9.81 * dt * dt * n * (n + 1) / 2, 1e-12);
    EXPECT_LT(flight.bodies.angular_momentum(0).norm(), 1e-12);
}

/// Springs from points of space to surface vertices, each stiffer than the previous one.
class EdgeStretchLimiter : public ActiveSetEnergy {
public:
    explicit EdgeStretchLimiter(int count) : blocks_(count)
    {
        for (int i = 0; i < count; ++i) {
            anchor_.push_back(Vec3(std::sin(i), std::cos(2.0 * i), std::sin(3.0 * i)));
            blocks_[i] = (1.0 + i) * Mat3::Identity();
        }
    }
    void begin_step(const StepStart&) override {}
    bool make_feasible(StepField) const override { return false; }
    bool sweep_once(StepField) const override { return false; }
    double add_gradient(View<const Vec3> x, View<Vec3> gradient) const override
    {
        double value = 0.0;
        for (int i = 0; i < x.size(); ++i) {
            gradient[i] += blocks_[i] * (x[i] - anchor_[i]);
            value += 0.5 * (x[i] - anchor_[i]).dot(blocks_[i] * (x[i] - anchor_[i]));
        }
        return value;
    }
    bool activate(View<const Vec3>) override { return true; }
    void add_hessian_product(View<const Vec3> p, View<Vec3> out) const override
    {
        for (int i = 0; i < p.size(); ++i)
            out[i] += blocks_[i] * p[i];
    }
    View<const Mat3> diagonal_blocks() const override { return blocks_; }
    void append_terms(std::vector<FrozenTerm>& terms) const override { terms = terms_; }
    bool revise(StepField, MinimiserProgress) override { return false; }
    void clear(StepField, StepField) override {}
    bool keep_apart(StepField, StepField) override { return false; }
    void end_step(StepField) override {}

    std::vector<Vec3> anchor_;
    std::vector<Mat3> blocks_;
    std::vector<FrozenTerm> terms_;
};

class RigidActiveSetTest : public testing::Test {
protected:
    RigidActiveSetTest()
        : bodies({rigid_shape_of(box_of(Vec3(0.1, 0.2, 0.3), Vec3(0, 1, 0), kTilt), 500.0, "box")}),
          stretch_limiter(2 + bodies.vertex_count()), energy(stretch_limiter, bodies, 2), q(4), v(4)
    {
        q[0] = Vec3(1, 0, 0);
        q[1] = Vec3(0, 0, 1);
        bodies.begin_step(0.01, View<Vec3>(q).subview(2, 2), View<Vec3>(v).subview(2, 2));
        q[3] = Vec3(0.05, -0.02, 0.03); // a rotation of about half a radian
    }

    RigidBodies bodies;
    EdgeStretchLimiter stretch_limiter;
    RigidActiveSet energy;
    std::vector<Vec3> q, v;
};

TEST_F(RigidActiveSetTest, HasTheGradientOfItsValue)
{
    std::vector<Vec3> gradient(4, Vec3::Zero()), ignored(4, Vec3::Zero());
    energy.add_gradient(q, gradient);
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k) {
            std::vector<Vec3> up = q, down = q;
            up[i][k] += 1e-6;
            down[i][k] -= 1e-6;
            const double slope =
                (energy.add_gradient(up, ignored) - energy.add_gradient(down, ignored)) / 2e-6;
            EXPECT_NEAR(gradient[i][k], slope, 1e-6 * (1.0 + std::abs(slope)));
        }
}

TEST_F(RigidActiveSetTest, BoundsItsHessianByItsBlocks)
{
    ASSERT_TRUE(energy.activate(q));
    Eigen::MatrixXd H(12, 12);
    for (int j = 0; j < 12; ++j) {
        std::vector<Vec3> p(4, Vec3::Zero()), out(4, Vec3::Zero());
        p[j / 3][j % 3] = 1.0;
        energy.add_hessian_product(p, out);
        for (int i = 0; i < 12; ++i)
            H(i, j) = out[i / 3][i % 3];
    }
    EXPECT_LT((H - H.transpose()).norm(), 1e-12 * H.norm());
    Eigen::MatrixXd excess = -H;
    for (int i = 0; i < 4; ++i)
        excess.block<3, 3>(3 * i, 3 * i) += energy.diagonal_blocks()[i];
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(excess).eigenvalues().minCoeff(),
              -1e-12 * H.norm());
}

TEST_F(RigidActiveSetTest, ReportsTheFreeSideOfTerms)
{
    stretch_limiter.terms_ = {{{4, 1, 0, -1}, {1.0, -0.25, -0.75, 0.0}, Mat3::Identity()},
                              {{2, 5, -1, -1}, {1.0, -1.0, 0.0, 0.0}, Mat3::Identity()}};
    std::vector<FrozenTerm> terms;
    energy.append_terms(terms);
    ASSERT_EQ(terms.size(), 1u);
    EXPECT_EQ(terms[0].vertex, (std::array<int, 4>{1, 0, -1, -1}));
    EXPECT_EQ(terms[0].weight, (std::array<double, 4>{-0.25, -0.75, 0.0, 0.0}));
}

TEST_F(RigidActiveSetTest, FindsThePoseOfARotatedSurface)
{
    std::vector<Vec3> x(bodies.vertex_count()), found(2);
    bodies.place(View<const Vec3>(q).subview(2, 2), x);
    bodies.fit(0, x, found);
    EXPECT_LT((found[0] - q[2]).norm(), 1e-13);
    EXPECT_LT((found[1] - q[3]).norm(), 1e-13);
}

} // namespace
} // namespace toile::test
