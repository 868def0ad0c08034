#pragma once

/// Kernels of DeviceHessianSolver: conjugate gradients for Newton's equation.

#include <cmath>

#include <Eigen/LU>

#include "core/compute/cuda/report.h"
#include "core/pd/cuda/newton/hierarchy_kernels.h"
#include "core/pd/newton/hessian_solver.h"

namespace toile {

/// Fields of the solver, all zero where fixed. K p follows from K z by the recurrence of p, so that all sums
/// of an iteration are known together [Chronopoulos & Gear 1989].
struct NewtonPcgFields {
    View<PaddedVec3> x, r, z, p; ///< [vertices] [m], [N], [m], [m]
    View<PaddedVec3> Kz, Kp;     ///< [vertices] [N]
};

/// Inverse of a 3 x 3 block on the diagonal: symmetric.
struct DiagonalInverse {
    Floats<4> first;  ///< xx, xy, xz, yy
    Floats<2> second; ///< yz, zz

    TOILE_HD PaddedVec3 operator*(const PaddedVec3& v) const
    {
        return PaddedVec3(first[0] * v[0] + first[1] * v[1] + first[2] * v[2],
                          first[1] * v[0] + first[3] * v[1] + second[0] * v[2],
                          first[2] * v[0] + second[0] * v[1] + second[1] * v[2], 0.0F);
    }
};

/// Inverts the block of vertex i: S_i - sum_j K_ij and the frozen terms, or a bound on these.
struct InvertDiagonal {
    SlicedHessian hessian;
    FrozenTerms terms;
    View<const unsigned char> fixed;
    View<Floats<4>> first;
    View<Floats<2>> second;

    TOILE_HD void operator()(int i) const
    {
        Mat3 block = hessian.sum[i] * Mat3::Identity();
        hessian.for_blocks(i, [&](int, const Eigen::Matrix3f& K) { block -= K.template cast<double>(); });
        double scalar = 0.0;
        hessian.for_scalars(i, [&](int, float s) { scalar -= double(s); });
        block.diagonal().array() += scalar;
        if (const int list = terms.list(i); list >= 0)
            block += terms.blocks[list];
        const Mat3 symmetric = 0.5 * (block + block.transpose());
        const Mat3 inverse = fixed[i] ? Mat3(Mat3::Zero()) : Mat3(symmetric.inverse());
        first[i] =
            Floats<4>(float(inverse(0, 0)), float(inverse(0, 1)), float(inverse(0, 2)), float(inverse(1, 1)));
        second[i] = Floats<2>(float(inverse(1, 2)), float(inverse(2, 2)));
    }
};

/// State of a solve.
struct NewtonPcgState {
    double rz = 0.0, first_rz = 0.0; ///< [J] r . z; at the start
    double pKp = 0.0;                ///< [J] p . K p
    double mass_pp = 0.0;            ///< [kg m^2] sum of mass times |p|^2
    double beta = 0.0, step = 0.0;   ///< [-]
    int iterations = 0, small = 0;   ///< the latter: small increments in succession
    bool is_over = false;            ///< no iteration follows
    bool advances = false;           ///< the current one makes its step
    bool is_solved = false;
};

/// Sums of an iteration; p and K p are those of the previous one.
struct NewtonPcgSums {
    static constexpr int kLargest = -1;

    double r_z = 0.0, p_r = 0.0, z_Kz = 0.0, z_Kp = 0.0; ///< [J]
    double mass_zz = 0.0, mass_zp = 0.0;                 ///< [kg m^2]

    TOILE_HD NewtonPcgSums& operator+=(const NewtonPcgSums& other)
    {
        r_z += other.r_z;
        p_r += other.p_r;
        z_Kz += other.z_Kz;
        z_Kp += other.z_Kp;
        mass_zz += other.mass_zz;
        mass_zp += other.mass_zp;
        return *this;
    }
};

/// Computes K z and the terms of all sums at vertex i.
struct MultiplyHessian {
    NewtonPcgFields fields;
    SlicedHessian hessian;
    View<const double> masses;       ///< [vertices] [kg]
    View<const unsigned char> fixed; ///< [vertices]

    TOILE_HD NewtonPcgSums operator()(int i) const { return finish(i, hessian.times(i, fields.z)); }

    TOILE_HD NewtonPcgSums finish(int i, const PaddedVec3& product) const
    {
        const PaddedVec3 r = fields.r[i], z = fields.z[i], p = fields.p[i], Kp = fields.Kp[i];
        const PaddedVec3 Kz = fixed[i] ? PaddedVec3(0.0F) : product;
        fields.Kz[i] = Kz;
        NewtonPcgSums sums;
        sums.r_z = dot(r, z);
        sums.p_r = dot(p, r);
        sums.z_Kz = dot(z, Kz);
        sums.z_Kp = dot(z, Kp);
        sums.mass_zz = masses[i] * dot(z, z);
        sums.mass_zp = masses[i] * dot(z, p);
        return sums;
    }
};

/// The same with frozen terms, whose product is computed by the previous launch.
struct MultiplyWithTerms {
    MultiplyHessian multiply;
    FrozenTerms terms;

    TOILE_HD PaddedVec3 prologue(int i) const { return multiply.hessian.times(i, multiply.fields.z); }

    TOILE_HD NewtonPcgSums operator()(int i) const { return (*this)(i, prologue(i)); }
    TOILE_HD NewtonPcgSums operator()(int i, const PaddedVec3& of_hessian) const
    {
        PaddedVec3 product = of_hessian;
        if (const int list = terms.list(i); list >= 0)
            product += padded(terms.product[list]);
        return multiply.finish(i, product);
    }
};

/// Computes the step along p = z + beta p', and decides whether the solve ends with it: HessianSolver::solve.
struct FindNewtonStep {
    View<NewtonPcgState> state; ///< [1]
    double mass;                ///< [kg] of the free vertices
    HessianSolver::Stop stop;

    TOILE_HD void operator()(const NewtonPcgSums& sums) const
    {
        NewtonPcgState& all = state[0];
        all.advances = !all.is_over;
        if (all.is_over)
            return;
        const double beta = all.rz > 0.0 ? sums.r_z / all.rz : 0.0;
        all.beta = beta;
        all.rz = sums.r_z;
        all.pKp = sums.z_Kz + beta * (2.0 * sums.z_Kp + beta * all.pKp);
        all.mass_pp = sums.mass_zz + beta * (2.0 * sums.mass_zp + beta * all.mass_pp);
        if (all.iterations == 0)
            all.first_rz = sums.r_z;
        if (!(sums.r_z > 0.0) || !(all.pKp > 0.0)) {
            all.is_over = all.is_solved = true;
            all.advances = false;
            return;
        }
        all.step = (sums.r_z + beta * sums.p_r) / all.pKp;
        ++all.iterations;
        const double size = std::fabs(all.step) * std::sqrt(all.mass_pp / mass);
        all.small = size < stop.increment ? all.small + 1 : 0;
        const double residual =
            stop.residual > 0.0 ? stop.residual : HessianSolver::kReduction * all.first_rz;
        all.is_solved = all.small >= 2 && sums.r_z <= residual;
        all.is_over = all.is_solved || all.iterations >= HessianSolver::kMaxIterations;
    }
};

/// Begins with x = 0, r = -g, and restricts r. By cluster.
struct BeginNewtonPcg {
    View<const Vec3> g;              ///< [vertices] [N]
    View<const unsigned char> fixed; ///< [vertices]
    NewtonPcgFields fields;
    ClusterFields clusters;
    View<NewtonPcgState> state; ///< [1]

    template <typename Team>
    TOILE_HD void operator()(int c, const Team& team, bool is_in_range) const
    {
        ClusterFields::Sums sums;
        if (c == 0 && team.thread == 0 && is_in_range)
            state[0] = {};
        if (is_in_range)
            clusters.for_vertices(c, team, [&](int i) {
                const PaddedVec3 r = fixed[i] ? PaddedVec3(0.0F) : padded(Vec3(-g[i]));
                fields.x[i] = fields.p[i] = fields.Kp[i] = PaddedVec3(0.0F);
                fields.r[i] = r;
                sums.add(clusters.clusters.functions[i], r);
            });
        clusters.store(c, team, sums, is_in_range);
    }
};

/// Computes z = P r. By cluster.
struct Precondition {
    NewtonPcgFields fields;
    ClusterFields clusters;
    View<const Floats<4>> first; ///< see InvertDiagonal
    View<const Floats<2>> second;

    template <typename Team>
    TOILE_HD void operator()(int c, const Team& team, bool is_in_range) const
    {
        if (!is_in_range)
            return;
        const ClusterFields::Coefficients coefficients = clusters.coefficients(c);
        clusters.for_vertices(c, team, [&](int i) {
            PaddedVec3 z = DiagonalInverse{first[i], second[i]} * fields.r[i];
            z += coefficients.at(clusters.clusters.functions[i]);
            fields.z[i] = z;
        });
    }
};

/// Makes the step, restricts the residual, and reports the state to the host. By cluster.
struct AdvanceNewtonPcg {
    NewtonPcgFields fields;
    ClusterFields clusters;
    View<const NewtonPcgState> state; ///< [1]
    SendReport<NewtonPcgState> report;

    template <typename Team>
    TOILE_HD void operator()(int c, const Team& team, bool is_in_range) const
    {
        if (c == 0 && team.thread == 0 && is_in_range)
            report(state[0]);
        if (!state[0].advances)
            return;
        const float step = float(state[0].step), beta = float(state[0].beta);
        ClusterFields::Sums sums;
        if (is_in_range)
            clusters.for_vertices(c, team, [&](int i) {
                PaddedVec3 p = fields.z[i], Kp = fields.Kz[i], x = fields.x[i], r = fields.r[i];
                p += beta * fields.p[i];
                Kp += beta * fields.Kp[i];
                x += step * p;
                r += -step * Kp;
                fields.p[i] = p;
                fields.Kp[i] = Kp;
                fields.x[i] = x;
                fields.r[i] = r;
                sums.add(clusters.clusters.functions[i], r);
            });
        clusters.store(c, team, sums, is_in_range);
    }
};

} // namespace toile
