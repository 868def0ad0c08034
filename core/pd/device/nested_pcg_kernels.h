#pragma once

#include <cmath>

#include <Eigen/LU>

#include "core/backend/cuda/report.h"
#include "core/linear/pcg.h"
#include "core/linear/sliced_rows.h"
#include "core/pd/device/device_active_set.h"

namespace toile {

/// NestedPcg with BlockInverse as a GPU runs it: the steps of an iteration before, in and after H^-1.
/// Flexible conjugate gradients [Notay 2000], rearranged so that all sums of an iteration are known at
/// once [Chronopoulos & Gear 1989]: K z is taken instead of K p = K z + beta K p', K = H + dH. In single
/// precision: what is wanted is a direction, a tenth of the residual away.
struct PcgFields {
    View<Vec3> x;                         ///< [vertices] [m]
    View<PaddedVec3> r, r_previous, z, p; ///< [vertices] [N], [m]
    View<PaddedVec3> Kz, Kp;              ///< [vertices] [N]
};

/// What an iteration sums up, p and K p being those of the one before.
struct PcgSums {
    static constexpr int kLargest = -1;

    double r_z = 0.0, previous_z = 0.0; ///< r . z, and with r of the iteration before [J]
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

/// Numbers of an iteration, and how the solve goes.
struct PcgScalars {
    double b_square = 0.0;               ///< [N^2] |b|^2
    double rz = 0.0;                     ///< r . z [J]
    double pKp = 0.0;                    ///< p . K p [J]
    double beta = 0.0;                   ///< [-] of p in its successor
    double step = 0.0;                   ///< [-] along p
    double gain = 0.0, total_gain = 0.0; ///< [J] twice what the quadratic loses by a step, by all
    double residual = 1.0;               ///< [-] |r| / |b|
    int iterations = 0;
    bool is_over = false; ///< this iteration is the last
    bool is_void = false; ///< and takes no step
};

/// H [vertices x vertices], and what is constant beside it.
struct SystemRows {
    static constexpr int kAtOnce = 8; ///< entries of a row that are loaded before any is waited for

    View<const int> first;        ///< [slices + 1] of WholeRows
    View<const RowEntry> entries; ///< [N/m]
    View<const float> sum;        ///< [vertices] of a row, found in double: what inertia leaves of it [N/m]
    View<const unsigned char> fixed; ///< [vertices]

    /// Row i: every kWarp-th entry.
    struct Row {
        int own, begin, end;
        float sum;
        bool is_fixed;
    };
    TOILE_HD Row row(int i) const
    {
        const int slice = i / WholeRows::kRows;
        return {i, first[slice] + i % WholeRows::kRows, first[slice + 1], sum[i], fixed[i] != 0};
    }

    /// Row times x, of which `own` is what the row's vertex has. By differences: where all vertices move
    /// alike, elastic rows cancel to the last bit and inertia, which may be less than the rounding of the
    /// diagonal, remains.
    TOILE_HD PaddedVec3 times(const Row& row, const PaddedVec3& own, View<const PaddedVec3> x) const
    {
        const PaddedVec3 back = -1.0F * own;
        PaddedVec3 product = row.sum * own;
        for (int k = row.begin; k < row.end; k += kAtOnce * kWarp) {
            const auto some = entries_from<kAtOnce>(entries, row.own, k, row.end);
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

/// E = (D + blocks)^-1: 1 / D where nothing is frozen.
struct BlocksInverse {
    View<const int> list_of;     ///< [vertices] as DeviceActiveSet::Frozen's
    View<const Mat3> inverse;    ///< [lists]
    View<const double> diagonal; ///< [vertices]

    /// What vertex i has of it.
    struct OfVertex {
        double diagonal;
        bool is_frozen;
        Mat3 inverse; ///< where frozen

        TOILE_HD Vec3 operator()(const Vec3& r) const
        {
            return is_frozen ? Vec3(inverse * r) : Vec3(r / diagonal);
        }

        /// D E r
        TOILE_HD PaddedVec3 scaled(const Vec3& r) const { return padded(diagonal * (*this)(r)); }
    };
    TOILE_HD OfVertex of(int i) const
    {
        const int list = list_of[i];
        OfVertex own{diagonal[i], list > 0, {}};
        if (own.is_frozen)
            own.inverse = inverse[list - 1];
        return own;
    }
};

/// E where nothing has been inverted yet.
struct InvertBlocks {
    DeviceActiveSet::Frozen frozen;
    View<const double> diagonal; ///< [vertices]
    View<Mat3> inverse;          ///< [lists] out

    /// Inverts what vertex i has.
    TOILE_HD BlocksInverse::OfVertex operator()(int i) const
    {
        const int list = frozen.list_of[i];
        BlocksInverse::OfVertex own{diagonal[i], list > 0, {}};
        if (own.is_frozen) {
            own.inverse = Mat3(frozen.blocks[list - 1] + own.diagonal * Mat3::Identity()).inverse();
            inverse[list - 1] = own.inverse;
        }
        return own;
    }
};

/// Begins: x = 0, r = b; a source (DeviceQuadrature::begin_solve) of D E r for the first H^-1.
struct BeginPcg {
    View<const Vec3> b;
    PcgFields fields;
    InvertBlocks invert;
    View<PcgScalars> scalars; ///< [1]

    struct Early {};
    TOILE_HD Early early(int) const { return {}; }

    TOILE_HD PaddedVec3 operator()(int i, const Early& = {}) const
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

/// z = E (r + D H^-1 D E r); a sink (DeviceQuadrature::end_solve) of H^-1, of which none is wanted after the
/// last step.
struct FinishPrecondition {
    PcgFields fields;
    BlocksInverse E;
    View<const PcgScalars> scalars;

    TOILE_HD bool is_wanted() const { return !scalars[0].is_over; }

    TOILE_HD void operator()(int i, const PaddedVec3& solved) const
    {
        const BlocksInverse::OfVertex own = E.of(i);
        fields.z[i] = padded(own(unpadded(fields.r[i]) + own.diagonal * unpadded(solved)));
    }
};

/// K z; z itself at fixed vertices. Terms of all sums. Comes right after the product of frozen terms.
struct MultiplySystem {
    PcgFields fields;
    SystemRows H;
    View<const int> list_of;         ///< [vertices]
    View<const Vec3> frozen_product; ///< [lists] dH z [N]

    /// All but the product of frozen terms: H z too.
    struct Early {
        PaddedVec3 r, Kp, p, previous, z, Hz;
        int list;
        bool is_fixed;
    };
    TOILE_HD Early early(int i) const
    {
        const SystemRows::Row row = H.row(i);
        const PaddedVec3 z = fields.z[i];
        return {fields.r[i], fields.Kp[i],
                fields.p[i], fields.r_previous[i],
                z,           row.is_fixed ? z : H.times(row, z, fields.z),
                list_of[i],  row.is_fixed};
    }

    TOILE_HD PcgSums operator()(int i) const { return (*this)(i, early(i)); }
    TOILE_HD PcgSums operator()(int i, const Early& own) const
    {
        const auto& [r, Kp, p, previous, z, Hz, list, is_fixed] = own;
        PaddedVec3 Kz = Hz;
        if (list > 0 && !is_fixed)
            Kz += padded(frozen_product[list - 1]);
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

/// Polak-Ribiere's beta, the step along p = z + beta p', what it leaves of r, and whether that is enough.
/// Where p is no direction of descent (rounding, or K is indefinite after all), the iterate so far is the
/// answer.
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

/// Moves along p, and tells the host how it goes; a source of D E r for the next H^-1, of which none is
/// needed after the last step. What goes to the host takes so long that no kernel with a sum should wait for
/// it.
struct TakeStep {
    PcgFields fields;
    BlocksInverse E;
    View<const PcgScalars> scalars;
    SendReport<PcgScalars> report;

    /// All but K z and what the sums decide.
    struct Early {
        Vec3 x;
        PaddedVec3 r, z, p, Kp;
        BlocksInverse::OfVertex E;
    };
    TOILE_HD Early early(int i) const
    {
        return {fields.x[i], fields.r[i], fields.z[i], fields.p[i], fields.Kp[i], E.of(i)};
    }

    TOILE_HD PaddedVec3 operator()(int i) const { return (*this)(i, early(i)); }
    TOILE_HD PaddedVec3 operator()(int i, const Early& own) const
    {
        if (i == 0)
            report(scalars[0]);
        if (scalars[0].is_void)
            return PaddedVec3(0.0F);
        const double step = scalars[0].step, beta = scalars[0].beta;
        const Vec3 p = unpadded(own.z) + beta * unpadded(own.p);
        const Vec3 Kp = unpadded(fields.Kz[i]) + beta * unpadded(own.Kp);
        const Vec3 r = unpadded(own.r) - step * Kp;
        fields.p[i] = padded(p);
        fields.Kp[i] = padded(Kp);
        fields.x[i] = own.x + step * p;
        fields.r_previous[i] = own.r;
        fields.r[i] = padded(r);
        return own.E.scaled(r);
    }
};

/// A source that fills an array, and a sink that reads one: for a solver that knows arrays only.
template <typename Source>
struct StoreSource {
    Source source;
    View<Vec3> b; ///< [vertices] out

    TOILE_HD typename Source::Early early(int i) const { return source.early(i); }
    TOILE_HD void operator()(int i, const typename Source::Early& own) const
    {
        b[i] = unpadded(source(i, own));
    }
};
template <typename Sink>
struct PassToSink {
    View<const Vec3> x; ///< [vertices]
    Sink sink;

    TOILE_HD void operator()(int i) const { sink(i, padded(x[i])); }
};

} // namespace toile
