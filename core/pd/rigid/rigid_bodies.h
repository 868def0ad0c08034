#pragma once

#include <string>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace toile {

/// Shape and mass of a rigid body, in the frame of its centre of mass and principal axes.
struct RigidShape {
    double mass = 0.0;            ///< [kg]
    Vec3 centre = Vec3::Zero();   ///< at the start, in world coordinates [m]
    Mat3 axes = Mat3::Identity(); ///< world_from_body at the start
    /// sqrt(I_k / mass) of the principal moments of inertia I_k [m]
    Vec3 gyration = Vec3::Ones();
    std::vector<Vec3> points; ///< [vertices] of the surface, in the frame above [m]
};

/// Mass, centre and inertia of the solid inside a closed surface of one density [kg/m^3].
/// @throws InvalidInput as solid_moments does
RigidShape rigid_shape_of(const TriangleMesh& surface, double density, const std::string& source);

/// Rigid bodies as point masses: each adds two unknowns to those that a Body minimises over,
///
///   q_c [m]  position of its centre,   q_u [m]  its rotation in this step, by
///   R(q_u) = exp(R_h S^-1 q_u) R_0,    S = diag(gyration),
///
/// both of mass m. S gives q_u the same mass as q_c. The inertia of a rigid body, I = m R_h S^2 R_h^T, is
/// then exactly that of two points, and the constant matrix H is the diagonal m/dt^2. R_0 is the rotation at
/// t0, R_h the rotation of a free body halfway through the step. This is the implicit midpoint rule, which
/// conserves angular momentum exactly and matches Euler's equations to second order.
///
/// A stiff affine body [Lan et al. 2022, Affine Body Dynamics] would need twelve unknowns. Its stiffness in H
/// would impede rotations, and implicit Euler damps its spin.
class RigidBodies {
public:
    explicit RigidBodies(std::vector<RigidShape> shapes);

    int count() const { return int(bodies_.size()); }
    int unknown_count() const { return 2 * count(); }
    int vertex_count() const { return first_.back(); } ///< of all surfaces, in the order of the bodies
    int first_vertex(int body) const { return first_[body]; }
    const RigidShape& shape(int body) const { return bodies_[body].shape; }
    std::vector<double> masses() const; ///< [unknowns] [kg]

    /// Current positions of the surfaces [vertices] [m].
    View<const Vec3> surface() const { return surface_; }

    /// @param linear, angular  [m/s], [rad/s] about the centre
    void set_velocity(int body, const Vec3& linear, const Vec3& angular);

    /// Motion of a body.
    struct Motion {
        Vec3 velocity = Vec3::Zero(); ///< [m/s] of the centre
        Vec3 spin = Vec3::Zero();     ///< angular momentum about the centre [kg m^2/s]
    };
    std::vector<Motion> motions() const;          ///< [bodies]
    void set_motions(View<const Motion> motions); ///< [bodies]

    Vec3 centre(int body) const { return bodies_[body].centre; }         ///< [m]
    Mat3 rotation(int body) const { return bodies_[body].rotation; }     ///< world_from_body
    Vec3 velocity(int body) const { return bodies_[body].velocity; }     ///< [m/s] of the centre
    Vec3 angular_momentum(int body) const { return bodies_[body].spin; } ///< about the centre [kg m^2/s]

    /// Writes the unknowns and their velocities at the start of a step of dt [s].
    /// @param q, v  [unknowns]
    void begin_step(double dt, View<Vec3> q, View<Vec3> v);

    /// Computes the surfaces [vertices] from the unknowns q.
    void place(View<const Vec3> q, View<Vec3> x) const;

    /// Stiffness [N/m] of a surface vertex's inertia, m_v/dt^2, with the effective mass at the vertex
    /// averaged over directions.
    double inertia(int vertex, double dt) const { return point_mass_[vertex] / (dt * dt); }

    /// Linear map from small changes of the unknowns to those of the surface, at q.
    struct Tangent {
        std::vector<Vec3> lever;          ///< [vertices] x - centre [m]
        std::vector<Mat3> rotation_per_u; ///< [bodies] infinitesimal rotation vector per change of q_u [1/m]
    };
    void linearise(View<const Vec3> q, View<const Vec3> x, Tangent& tangent) const;

    /// Computes p_x = J p_q.
    void spread(const Tangent& tangent, View<const Vec3> p_q, View<Vec3> p_x) const;
    /// Adds f_q += J^T f_x.
    void gather(const Tangent& tangent, View<const Vec3> f_x, View<Vec3> f_q) const;
    /// Blocks on the unknowns that bound J^T blockdiag(B) J: |a + b|^2 <= 2 |a|^2 + 2 |b|^2. [unknowns]
    void bound(const Tangent& tangent, View<const Mat3> B, View<Mat3> bounds) const;

    /// Computes the unknowns of one body whose surface is nearest to x [vertices of the body].
    void fit(int body, View<const Vec3> x, View<Vec3> q) const;

    /// Takes the final state of a step.
    /// @param q, v  [unknowns]
    void end_step(View<const Vec3> q, View<const Vec3> v);

private:
    struct Moving {
        RigidShape shape;
        Vec3 centre = Vec3::Zero();
        Mat3 rotation = Mat3::Identity();      ///< R_0
        Mat3 half_rotation = Mat3::Identity(); ///< R_h
        Vec3 velocity = Vec3::Zero();
        Vec3 spin = Vec3::Zero(); ///< angular momentum

        Mat3 rate_per_u() const; ///< R_h S^-1
    };

    std::vector<Moving> bodies_;
    std::vector<int> first_;         ///< [bodies + 1]
    std::vector<double> point_mass_; ///< [vertices] [kg]
    std::vector<Vec3> surface_;      ///< [vertices]
};

} // namespace toile
