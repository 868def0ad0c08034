#include "core/pd/rigid/rigid_bodies.h"

#include <cmath>
#include <utility>

#include <Eigen/Dense>

#include "core/compute/parallel.h"
#include "core/mesh/rotation.h"
#include "core/mesh/solid_moments.h"

namespace toile {

namespace {

/// Fixed-point iterations for the half-step rotation. Each multiplies the error by about half the step's
/// angle [rad].
constexpr int kMidpointIterations = 4;

/// Rotations below this [rad] use the limits of their formulas.
constexpr double kMinAngle = 1e-9;

Mat3 cross_matrix(const Vec3& a)
{
    Mat3 m;
    m << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
    return m;
}

/// Left Jacobian J of SO(3): exp(rotation + d) = exp(J d) exp(rotation) to first order.
Mat3 left_jacobian(const Vec3& rotation)
{
    const double angle = rotation.norm();
    const Mat3 K = cross_matrix(rotation);
    if (angle < kMinAngle)
        return Mat3::Identity() + 0.5 * K;
    const double square = angle * angle;
    return Mat3::Identity() + (1.0 - std::cos(angle)) / square * K +
           (angle - std::sin(angle)) / (square * angle) * K * K;
}

/// Angular velocity of a free body [rad/s].
Vec3 rate_of(const Mat3& R, const RigidShape& shape, const Vec3& spin)
{
    const Vec3 moments = shape.mass * shape.gyration.cwiseAbs2();
    return R * (R.transpose() * spin).cwiseQuotient(moments);
}

} // namespace

RigidShape rigid_shape_of(const TriangleMesh& surface, double density, const std::string& source)
{
    const SolidMoments moments = solid_moments(surface, source);
    RigidShape shape;
    shape.mass = density * moments.volume;
    shape.centre = moments.centre;

    // The axes of the second moments are also those of the inertia, I = tr(J) 1 - J.
    const Eigen::SelfAdjointEigenSolver<Mat3> axes(moments.second);
    shape.axes = axes.eigenvectors();
    if (shape.axes.determinant() < 0.0)
        shape.axes.col(2) = -shape.axes.col(2);
    const Vec3 squares = axes.eigenvalues() / moments.volume;
    shape.gyration = (squares.sum() - squares.array()).sqrt();
    for (const Vec3& x : surface.positions)
        shape.points.push_back(shape.axes.transpose() * (x - shape.centre));
    return shape;
}

Mat3 RigidBodies::Moving::rate_per_u() const
{
    return half_rotation * shape.gyration.cwiseInverse().asDiagonal();
}

RigidBodies::RigidBodies(std::vector<RigidShape> shapes) : first_{0}
{
    for (RigidShape& shape : shapes) {
        first_.push_back(first_.back() + int(shape.points.size()));
        for (const Vec3& X : shape.points) {
            surface_.push_back(shape.centre + shape.axes * X);
            // Average the mobility over directions: a third of the trace of J M^-1 J^T.
            double mobility = 1.0;
            for (int k = 0; k < 3; ++k)
                mobility += (X.squaredNorm() - X[k] * X[k]) / (3.0 * shape.gyration[k] * shape.gyration[k]);
            point_mass_.push_back(shape.mass / mobility);
        }
        Moving& body = bodies_.emplace_back();
        body.centre = shape.centre;
        body.rotation = body.half_rotation = shape.axes;
        body.shape = std::move(shape);
    }
}

std::vector<double> RigidBodies::masses() const
{
    std::vector<double> masses;
    for (const Moving& body : bodies_)
        masses.insert(masses.end(), 2, body.shape.mass);
    return masses;
}

void RigidBodies::set_velocity(int body, const Vec3& linear, const Vec3& angular)
{
    Moving& b = bodies_[body];
    const Vec3 moments = b.shape.mass * b.shape.gyration.cwiseAbs2();
    b.velocity = linear;
    b.spin = b.rotation * moments.cwiseProduct(b.rotation.transpose() * angular);
}

std::vector<RigidBodies::Motion> RigidBodies::motions() const
{
    std::vector<Motion> motions;
    for (const Moving& b : bodies_)
        motions.push_back({b.velocity, b.spin});
    return motions;
}

void RigidBodies::set_motions(View<const Motion> motions)
{
    for (int i = 0; i < count(); ++i) {
        bodies_[i].velocity = motions[i].velocity;
        bodies_[i].spin = motions[i].spin;
    }
}

void RigidBodies::begin_step(double dt, View<Vec3> q, View<Vec3> v)
{
    for (int i = 0; i < count(); ++i) {
        Moving& b = bodies_[i];
        Vec3 rate = rate_of(b.rotation, b.shape, b.spin);
        for (int iteration = 0; iteration < kMidpointIterations; ++iteration) {
            b.half_rotation = rotation_from_vector(0.5 * dt * rate) * b.rotation;
            rate = rate_of(b.half_rotation, b.shape, b.spin);
        }
        q[2 * i] = b.centre;
        q[2 * i + 1].setZero();
        v[2 * i] = b.velocity;
        v[2 * i + 1] = b.shape.gyration.cwiseProduct(b.half_rotation.transpose() * rate);
    }
}

void RigidBodies::place(View<const Vec3> q, View<Vec3> x) const
{
    parallel_tasks(kCpu, count(), [&](int i) {
        const Moving& b = bodies_[i];
        const Mat3 R = rotation_from_vector(b.rate_per_u() * q[2 * i + 1]) * b.rotation;
        for (int v = first_[i]; v < first_[i + 1]; ++v)
            x[v] = q[2 * i] + R * b.shape.points[v - first_[i]];
    });
}

void RigidBodies::linearise(View<const Vec3> q, View<const Vec3> x, Tangent& tangent) const
{
    tangent.lever.resize(vertex_count());
    tangent.rotation_per_u.resize(count());
    parallel_tasks(kCpu, count(), [&](int i) {
        const Mat3 rate = bodies_[i].rate_per_u();
        tangent.rotation_per_u[i] = left_jacobian(rate * q[2 * i + 1]) * rate;
        for (int v = first_[i]; v < first_[i + 1]; ++v)
            tangent.lever[v] = x[v] - q[2 * i];
    });
}

void RigidBodies::spread(const Tangent& tangent, View<const Vec3> p_q, View<Vec3> p_x) const
{
    parallel_tasks(kCpu, count(), [&](int i) {
        const Vec3 rotation = tangent.rotation_per_u[i] * p_q[2 * i + 1];
        for (int v = first_[i]; v < first_[i + 1]; ++v)
            p_x[v] = p_q[2 * i] + rotation.cross(tangent.lever[v]);
    });
}

void RigidBodies::gather(const Tangent& tangent, View<const Vec3> f_x, View<Vec3> f_q) const
{
    parallel_tasks(kCpu, count(), [&](int i) {
        Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
        for (int v = first_[i]; v < first_[i + 1]; ++v) {
            force += f_x[v];
            torque += tangent.lever[v].cross(f_x[v]);
        }
        f_q[2 * i] += force;
        f_q[2 * i + 1] += tangent.rotation_per_u[i].transpose() * torque;
    });
}

void RigidBodies::bound(const Tangent& tangent, View<const Mat3> B, View<Mat3> bounds) const
{
    parallel_tasks(kCpu, count(), [&](int i) {
        Mat3 moved = Mat3::Zero(), rotated = Mat3::Zero();
        for (int v = first_[i]; v < first_[i + 1]; ++v) {
            if (B[v].isZero(0.0))
                continue;
            const Mat3 lever = cross_matrix(tangent.lever[v]);
            moved += B[v];
            rotated += lever.transpose() * B[v] * lever;
        }
        bounds[2 * i] = 2.0 * moved;
        bounds[2 * i + 1] = 2.0 * tangent.rotation_per_u[i].transpose() * rotated * tangent.rotation_per_u[i];
    });
}

void RigidBodies::fit(int body, View<const Vec3> x, View<Vec3> q) const
{
    const Moving& b = bodies_[body];
    const std::vector<Vec3>& X = b.shape.points;
    Vec3 mean_X = Vec3::Zero(), mean_x = Vec3::Zero();
    for (int k = 0; k < x.size(); ++k) {
        mean_X += X[k] / x.size();
        mean_x += x[k] / x.size();
    }

    // Fit x = mean_x + A (X - mean_X) by least squares: exact for an affine image.
    Mat3 products = Mat3::Zero(), squares = Mat3::Zero();
    for (int k = 0; k < x.size(); ++k) {
        products += (x[k] - mean_x) * (X[k] - mean_X).transpose();
        squares += (X[k] - mean_X) * (X[k] - mean_X).transpose();
    }
    const Mat3 A = products * squares.inverse();
    const Vec3 rotation = rotation_vector_of(nearest_rotation(A) * b.rotation.transpose());
    q[0] = mean_x - A * mean_X;
    q[1] = b.shape.gyration.cwiseProduct(b.half_rotation.transpose() * rotation);
}

void RigidBodies::end_step(View<const Vec3> q, View<const Vec3> v)
{
    place(q, surface_);
    for (int i = 0; i < count(); ++i) {
        Moving& b = bodies_[i];
        // Use the nearest rotation, because thousands of products would drift.
        b.rotation = nearest_rotation(rotation_from_vector(b.rate_per_u() * q[2 * i + 1]) * b.rotation);
        b.centre = q[2 * i];
        b.velocity = v[2 * i];
        b.spin = b.half_rotation * (b.shape.mass * b.shape.gyration.cwiseProduct(v[2 * i + 1]));
    }
}

} // namespace toile
