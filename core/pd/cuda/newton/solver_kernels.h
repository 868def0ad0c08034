#pragma once

/// Kernels of DeviceHessianSolver: conjugate gradients for Newton's equation.

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
        if (const int list = terms.list_of[i]; list >= 0)
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
    double rz = 0.0, pKp = 0.0;    ///< [J] r . z, p . K p
    double beta = 0.0, step = 0.0; ///< [-]
    bool is_over = false;          ///< no iteration follows
    bool advances = false;         ///< the current one makes its step
    HessianSolver::Outcome outcome;
};

/// Sums of an iteration; p and K p are those of the previous one.
struct NewtonPcgSums {
    static constexpr int kLargest = -1;

    double r_z = 0.0, p_r = 0.0, z_Kz = 0.0, z_Kp = 0.0; ///< [J]

    TOILE_HD NewtonPcgSums& operator+=(const NewtonPcgSums& other)
    {
        r_z += other.r_z;
        p_r += other.p_r;
        z_Kz += other.z_Kz;
        z_Kp += other.z_Kp;
        return *this;
    }
};

/// Computes K z. By vertex; with frozen terms it follows the launch that computes their product.
struct MultiplyHessian {
    NewtonPcgFields fields;
    SlicedHessian hessian;
    FrozenTerms terms;
    View<const unsigned char> fixed; ///< [vertices]

    template <typename Team>
    TOILE_HD PaddedVec3 of_thread(int i, const Team& team) const
    {
        return hessian.part_of_row(i, team.thread, Team::width(), fields.z);
    }
    template <typename Team>
    TOILE_HD void store(int i, const Team& team, bool is_in_range, const PaddedVec3& part) const
    {
        PaddedVec3 product(0.0F);
        for (int k = 0; k < 3; ++k)
            product.value[k] = team.sum(1, part[k]);
        if (team.thread != 0 || !is_in_range)
            return;
        if (const int list = terms.list_of[i]; list >= 0)
            product += padded(terms.product[list]);
        fields.Kz[i] = fixed[i] != 0 ? PaddedVec3(0.0F) : product;
    }

    template <typename Team>
    TOILE_HD void operator()(int i, const Team& team, bool is_in_range) const
    {
        store(i, team, is_in_range, of_thread(i, team));
    }
};

/// The same where the previous launch computes the frozen terms' product, and all of z is there.
struct MultiplyBesideTerms {
    MultiplyHessian multiply;

    template <typename Team>
    TOILE_HD PaddedVec3 prologue(int i, const Team& team, bool /*is_in_range*/) const
    {
        return multiply.of_thread(i, team);
    }
    template <typename Team>
    TOILE_HD void operator()(int i, const Team& team, bool is_in_range) const
    {
        (*this)(i, team, is_in_range, prologue(i, team, is_in_range));
    }
    template <typename Team>
    TOILE_HD void operator()(int i, const Team& team, bool is_in_range, const PaddedVec3& part) const
    {
        multiply.store(i, team, is_in_range, part);
    }
};

/// Terms of all sums at vertex i.
struct MeasureIteration {
    NewtonPcgFields fields;

    /// What the product does not write.
    struct Prologue {
        PaddedVec3 r, z, p, Kp;
    };
    TOILE_HD Prologue prologue(int i) const { return {fields.r[i], fields.z[i], fields.p[i], fields.Kp[i]}; }
    TOILE_HD NewtonPcgSums operator()(int i) const { return (*this)(i, prologue(i)); }
    TOILE_HD NewtonPcgSums operator()(int i, const Prologue& local) const
    {
        NewtonPcgSums sums;
        sums.r_z = dot(local.r, local.z);
        sums.p_r = dot(local.p, local.r);
        sums.z_Kz = dot(local.z, fields.Kz[i]);
        sums.z_Kp = dot(local.z, local.Kp);
        return sums;
    }
};

/// Computes the step along p = z + beta p', and decides whether the solve ends with it: HessianSolver::solve.
struct FindNewtonStep {
    View<NewtonPcgState> state; ///< [1]
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
        if (!(sums.r_z > 0.0) || !(all.pKp > 0.0)) {
            all.is_over = true;
            all.outcome.is_solved = sums.r_z == 0.0;
            all.outcome.error = all.outcome.is_solved ? 0.0 : all.outcome.error;
            all.advances = false;
            return;
        }
        all.step = (sums.r_z + beta * sums.p_r) / all.pKp;
        all.outcome.advance(all.step, beta, all.rz, stop);
        all.is_over = all.outcome.is_solved || all.outcome.iterations >= HessianSolver::kMaxIterations;
    }
};

/// Begins with x = 0, r = -g, and restricts r. By cluster.
struct BeginNewtonPcg {
    View<const Vec3> g;              ///< [vertices] [N]
    View<const unsigned char> fixed; ///< [vertices]
    NewtonPcgFields fields;
    ClusterFields clusters;
    View<NewtonPcgState> state; ///< [1]

    template <typename Block>
    TOILE_HD void operator()(int c, const Block& block) const
    {
        if (c == 0 && block.thread == 0)
            state[0] = {};
        const int i = clusters.clusters.vertex(c, block.thread);
        PaddedVec3 r(0.0F);
        if (i >= 0) {
            if (fixed[i] == 0)
                r = padded(Vec3(-g[i]));
            fields.x[i] = fields.p[i] = fields.Kp[i] = PaddedVec3(0.0F);
            fields.r[i] = r;
        }
        clusters.restrict_from(c, block, i, r);
    }
};

/// Computes z = P r. By cluster.
struct Precondition {
    NewtonPcgFields fields;
    ClusterFields clusters;
    View<const Floats<4>> first; ///< see InvertDiagonal
    View<const Floats<2>> second;

    /// Constant data: without clusters nothing is launched between the residual and this.
    struct Prologue {
        int i;
        DiagonalInverse inverse;
    };
    template <typename Block>
    TOILE_HD Prologue prologue(int c, const Block& block) const
    {
        const int i = clusters.clusters.vertex(c, block.thread);
        return {i, i >= 0 ? DiagonalInverse{first[i], second[i]} : DiagonalInverse{}};
    }
    template <typename Block>
    TOILE_HD void operator()(int c, const Block& block) const
    {
        (*this)(c, block, prologue(c, block));
    }
    template <typename Block>
    TOILE_HD void operator()(int c, const Block&, const Prologue& local) const
    {
        if (local.i < 0)
            return;
        PaddedVec3 z = local.inverse * fields.r[local.i];
        z += clusters.coefficients(c).at(clusters.clusters.functions[local.i]);
        fields.z[local.i] = z;
    }
};

/// Makes the step, restricts the residual, and reports the state to the host. By cluster.
struct AdvanceNewtonPcg {
    NewtonPcgFields fields;
    ClusterFields clusters;
    View<const NewtonPcgState> state; ///< [1]
    SendReport<NewtonPcgState> report;

    /// What the sums do not change.
    struct Prologue {
        int i;
        PaddedVec3 p, Kp, x, r, z, Kz;
    };
    template <typename Block>
    TOILE_HD Prologue prologue(int c, const Block& block) const
    {
        const int i = clusters.clusters.vertex(c, block.thread);
        if (i < 0)
            return {i, {}, {}, {}, {}, {}, {}};
        return {i, fields.p[i], fields.Kp[i], fields.x[i], fields.r[i], fields.z[i], fields.Kz[i]};
    }
    template <typename Block>
    TOILE_HD void operator()(int c, const Block& block) const
    {
        (*this)(c, block, prologue(c, block));
    }
    template <typename Block>
    TOILE_HD void operator()(int c, const Block& block, const Prologue& local) const
    {
        if (c == 0 && block.thread == 0)
            report(state[0]);
        if (!state[0].advances)
            return;
        const float step = float(state[0].step), beta = float(state[0].beta);
        PaddedVec3 r(0.0F);
        if (const int i = local.i; i >= 0) {
            PaddedVec3 p = local.z, Kp = local.Kz, x = local.x;
            r = local.r;
            p += beta * local.p;
            Kp += beta * local.Kp;
            x += step * p;
            r += -step * Kp;
            fields.p[i] = p;
            fields.Kp[i] = Kp;
            fields.x[i] = x;
            fields.r[i] = r;
        }
        clusters.restrict_from(c, block, local.i, r);
    }
};

} // namespace toile
