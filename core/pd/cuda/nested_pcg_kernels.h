#pragma once

#include <cmath>

#include <Eigen/LU>

#include "core/compute/cuda/report.h"
#include "core/linear/pcg.h"
#include "core/linear/sliced_rows.h"
#include "core/pd/cuda/active_set.h"

namespace toile {

/// Fields of NestedPcg with BlockInverse as a GPU runs it; the kernels are the parts of an iteration before,
/// in and after H^-1. Flexible conjugate gradients [Notay 2000], rearranged so that all sums of an iteration
/// are known together [Chronopoulos & Gear 1989]: K z is computed instead of K p = K z + beta K p', K = H +
/// dH. Single precision suffices: the result is a direction, to a tenth of the residual.
struct PcgFields {
    View<Vec3> x;                         ///< [vertices] [m]
    View<PaddedVec3> r, r_previous, z, p; ///< [vertices] [N], [m]
    View<PaddedVec3> Kz, Kp;              ///< [vertices] [N]
};

/// Sums of an iteration; p and K p are the previous iteration's.
struct PcgSums {
    static constexpr int kLargest = -1;

    double r_z = 0.0, previous_z = 0.0; ///< r . z, and z . the previous r [J]
    double z_Kz = 0.0, z_Kp = 0.0, p_r = 0.0;
    double r_r = 0.0, r_Kz = 0.0, r_Kp = 0.0; ///< [N^2]
    double Kz_Kz = 0.0, Kz_Kp = 0.0, Kp_Kp = 0.0;

    TOILE_HD PcgSums& operator+=(const PcgSums& other)
    {
        r_z += other.r_z;
        previous_z += other.previous_z;
        z_Kz += other.z_Kz;
        z_Kp += other.z_Kp;
        p_r += other.p_r;
        r_r += other.r_r;
        r_Kz += other.r_Kz;
        r_Kp += other.r_Kp;
        Kz_Kz += other.Kz_Kz;
        Kz_Kp += other.Kz_Kp;
        Kp_Kp += other.Kp_Kp;
        return *this;
    }
};

/// Numbers of an iteration, and the state of the solve.
struct PcgScalars {
    double b_square = 0.0;               ///< [N^2] |b|^2
    double rz = 0.0;                     ///< r . z [J]
    double pKp = 0.0;                    ///< p . K p [J]
    double beta = 0.0;                   ///< [-] coefficient of the previous p
    double step = 0.0;                   ///< [-] along p
    double gain = 0.0, total_gain = 0.0; ///< [J] twice the decrease of the quadratic by this step, and by all
    double residual = 1.0;               ///< [-] |r| / |b|
    int iterations = 0;
    bool is_over = false; ///< this iteration is the last
    bool is_void = false; ///< the last iteration takes no step
};

/// H [vertices x vertices], and constant data beside it.
struct SystemRows {
    static constexpr int kAtOnce = 8; ///< entries of a row that are loaded together

    View<const int> first;           ///< [slices + 1] of WholeRows
    View<const RowEntry> entries;    ///< [N/m]
    View<const float> sum;           ///< [vertices] row sums, in double on the host: inertia's part [N/m]
    View<const unsigned char> fixed; ///< [vertices]

    /// Row i: every kWarp-th entry from begin to end.
    struct Row {
        int index, begin, end;
        float sum;
        bool is_fixed;
    };
    TOILE_HD Row row(int i) const
    {
        const int slice = i / WholeRows::kRows;
        return {i, first[slice] + i % WholeRows::kRows, first[slice + 1], sum[i], fixed[i] != 0};
    }

    /// Row times x; `local` is x at the row's vertex. Computed from differences: under a common translation
    /// elastic rows cancel to the last bit. Inertia, which may be less than the rounding of the diagonal,
    /// then remains.
    TOILE_HD PaddedVec3 times(const Row& row, const PaddedVec3& local, View<const PaddedVec3> x) const
    {
        const PaddedVec3 back = -1.0F * local;
        PaddedVec3 product = row.sum * local;
        for (int k = row.begin; k < row.end; k += kAtOnce * kWarp) {
            const auto some = entries_from<kAtOnce>(entries, row.index, k, row.end);
            PaddedVec3 values[kAtOnce];
            for (int n = 0; n < kAtOnce; ++n)
                values[n] = x[some[n].column];
            for (int n = 0; n < kAtOnce; ++n) {
                values[n] += back;
                product += some[n].value * values[n];
            }
        }
        return product;
    }
};

/// E = (D + blocks)^-1: 1 / D at vertices without frozen terms.
struct BlocksInverse {
    ListOfVertex list_of;
    View<const Mat3> inverse;    ///< [lists]
    View<const double> diagonal; ///< [vertices]

    /// Entry of E for one vertex.
    struct OfVertex {
        double diagonal;
        bool is_frozen;
        Mat3 inverse; ///< where frozen

        TOILE_HD Vec3 operator()(const Vec3& r) const
        {
            return is_frozen ? Vec3(inverse * r) : Vec3(r / diagonal);
        }

        /// Computes D E r.
        TOILE_HD PaddedVec3 scaled(const Vec3& r) const { return padded(diagonal * (*this)(r)); }
    };
    TOILE_HD OfVertex of(int i) const
    {
        const int list = list_of[i];
        OfVertex local{diagonal[i], list >= 0, {}};
        if (local.is_frozen)
            local.inverse = inverse[list];
        return local;
    }
};

/// Computes E before its blocks have been inverted.
struct InvertBlocks {
    DeviceActiveSet::Frozen frozen;
    View<const double> diagonal; ///< [vertices]
    View<Mat3> inverse;          ///< [lists] out

    /// Inverts the block of vertex i.
    TOILE_HD BlocksInverse::OfVertex operator()(int i) const
    {
        const int list = frozen.list_of[i];
        BlocksInverse::OfVertex local{diagonal[i], list >= 0, {}};
        if (local.is_frozen) {
            local.inverse = Mat3(frozen.blocks[list] + local.diagonal * Mat3::Identity()).inverse();
            inverse[list] = local.inverse;
        }
        return local;
    }
};

/// Begins with x = 0, r = b. Source (DeviceQuadrature::begin_solve) of D E r for the first H^-1.
struct BeginPcg {
    View<const Vec3> b;
    PcgFields fields;
    InvertBlocks invert;
    View<PcgScalars> scalars; ///< [1]

    struct Prologue {};
    TOILE_HD Prologue prologue(int) const { return {}; }

    TOILE_HD PaddedVec3 operator()(int i, const Prologue& = {}) const
    {
        if (i == 0)
            scalars[0] = {};
        const Vec3 r = b[i];
        fields.x[i] = Vec3(0.0, 0.0, 0.0);
        fields.p[i] = fields.Kp[i] = fields.r_previous[i] = PaddedVec3(0.0F);
        fields.r[i] = padded(r);
        return invert(i).scaled(r);
    }
};

/// Computes z = E (r + D H^-1 D E r). Sink (DeviceQuadrature::end_solve) of H^-1, not wanted after the last
/// step.
struct FinishPrecondition {
    PcgFields fields;
    BlocksInverse E;
    View<const PcgScalars> scalars;

    TOILE_HD bool is_wanted() const { return !scalars[0].is_over; }

    TOILE_HD void operator()(int i, const PaddedVec3& solved) const
    {
        const BlocksInverse::OfVertex local = E.of(i);
        fields.z[i] = padded(local(unpadded(fields.r[i]) + local.diagonal * unpadded(solved)));
    }
};

/// Computes K z (z itself at fixed vertices) and the terms of all sums. Launched directly after the product
/// of frozen terms.
struct MultiplySystem {
    PcgFields fields;
    SystemRows H;
    ListOfVertex list_of;
    View<const Vec3> frozen_product; ///< [lists] dH z [N]

    /// Data independent of the product of frozen terms, including H z.
    struct Prologue {
        PaddedVec3 r, Kp, p, previous, z, Hz;
        int list;
        bool is_fixed;
    };
    TOILE_HD Prologue prologue(int i) const
    {
        const SystemRows::Row row = H.row(i);
        const PaddedVec3 z = fields.z[i];
        return {fields.r[i], fields.Kp[i],
                fields.p[i], fields.r_previous[i],
                z,           row.is_fixed ? z : H.times(row, z, fields.z),
                list_of[i],  row.is_fixed};
    }

    TOILE_HD PcgSums operator()(int i) const { return (*this)(i, prologue(i)); }
    TOILE_HD PcgSums operator()(int i, const Prologue& local) const
    {
        const auto& [r, Kp, p, previous, z, Hz, list, is_fixed] = local;
        PaddedVec3 Kz = Hz;
        if (list >= 0 && !is_fixed)
            Kz += padded(frozen_product[list]);
        fields.Kz[i] = Kz;
        PcgSums sums;
        sums.r_z = dot(r, z);
        sums.previous_z = dot(previous, z);
        sums.z_Kz = dot(z, Kz);
        sums.z_Kp = dot(z, Kp);
        sums.p_r = dot(p, r);
        sums.r_r = dot(r, r);
        sums.r_Kz = dot(r, Kz);
        sums.r_Kp = dot(r, Kp);
        sums.Kz_Kz = dot(Kz, Kz);
        sums.Kz_Kp = dot(Kz, Kp);
        sums.Kp_Kp = dot(Kp, Kp);
        return sums;
    }
};

/// Computes Polak-Ribiere's beta, the step along p = z + beta p' and the residual after it, and decides
/// whether that suffices. If p is no descent direction (rounding, or K is indefinite), the current iterate is
/// the result.
struct FindStep {
    View<PcgScalars> scalars; ///< [1]
    Pcg::Settings settings;

    TOILE_HD void operator()(const PcgSums& sums) const
    {
        PcgScalars& all = scalars[0];
        if (all.iterations == 0)
            all.b_square = sums.r_r;
        const double beta = all.rz != 0.0 ? (sums.r_z - sums.previous_z) / all.rz : 0.0;
        all.beta = beta;
        all.rz = sums.r_z;
        all.pKp = sums.z_Kz + beta * (2.0 * sums.z_Kp + beta * all.pKp);
        all.is_over = all.is_void = !(all.pKp > 0.0);
        if (all.is_void)
            return;
        ++all.iterations;
        all.step = (sums.r_z + beta * sums.p_r) / all.pKp;
        all.gain = all.step * all.step * all.pKp;
        all.total_gain += all.gain;
        const double r_Kp = sums.r_Kz + beta * sums.r_Kp;
        const double Kp_Kp = sums.Kz_Kz + beta * (2.0 * sums.Kz_Kp + beta * sums.Kp_Kp);
        const double r_square = sums.r_r + all.step * (all.step * Kp_Kp - 2.0 * r_Kp);
        all.residual = std::sqrt(std::fmax(0.0, r_square) / all.b_square);
        all.is_over = all.iterations >= settings.max_iterations || all.residual <= settings.tolerance ||
                      !settings.is_worth_more(all.iterations, all.gain, all.total_gain);
    }
};

/// Moves along p, and reports the state to the host. Source of D E r for the next H^-1, not needed after the
/// last step. The report takes so long that no kernel with a sum should wait for it.
struct TakeStep {
    PcgFields fields;
    BlocksInverse E;
    View<const PcgScalars> scalars;
    SendReport<PcgScalars> report;

    /// Data that neither K z nor the sums affect.
    struct Prologue {
        Vec3 x;
        PaddedVec3 r, z, p, Kp;
        BlocksInverse::OfVertex E;
    };
    TOILE_HD Prologue prologue(int i) const
    {
        return {fields.x[i], fields.r[i], fields.z[i], fields.p[i], fields.Kp[i], E.of(i)};
    }

    TOILE_HD PaddedVec3 operator()(int i) const { return (*this)(i, prologue(i)); }
    TOILE_HD PaddedVec3 operator()(int i, const Prologue& local) const
    {
        if (i == 0)
            report(scalars[0]);
        if (scalars[0].is_void)
            return PaddedVec3(0.0F);
        const double step = scalars[0].step, beta = scalars[0].beta;
        const Vec3 p = unpadded(local.z) + beta * unpadded(local.p);
        const Vec3 Kp = unpadded(fields.Kz[i]) + beta * unpadded(local.Kp);
        const Vec3 r = unpadded(local.r) - step * Kp;
        fields.p[i] = padded(p);
        fields.Kp[i] = padded(Kp);
        fields.x[i] = local.x + step * p;
        fields.r_previous[i] = local.r;
        fields.r[i] = padded(r);
        return local.E.scaled(r);
    }
};

/// Adapters for a solver that works on arrays: a source that fills an array, and a sink that reads one.
template <typename Source>
struct StoreSource {
    Source source;
    View<Vec3> b; ///< [vertices] out

    TOILE_HD typename Source::Prologue prologue(int i) const { return source.prologue(i); }
    TOILE_HD void operator()(int i, const typename Source::Prologue& local) const
    {
        b[i] = unpadded(source(i, local));
    }
};
template <typename Sink>
struct PassToSink {
    View<const Vec3> x; ///< [vertices]
    Sink sink;

    TOILE_HD void operator()(int i) const { sink(i, padded(x[i])); }
};

} // namespace toile
