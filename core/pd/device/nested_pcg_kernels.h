#pragma once

#include <cmath>

#include <Eigen/LU>

#include "core/backend/types.h"
#include "core/pd/device/device_active_set.h"

namespace toile {

/// NestedPcg with BlockInverse as a GPU runs it: the steps of an iteration that lie between applications of
/// H^-1, in as few passes as there can be. Flexible conjugate gradients [Notay 2000].
struct PcgFields {
    View<Vec3> x, r, r_previous, z, p, product; ///< [vertices]
    View<Vec3> scaled;                          ///< [vertices] D E r [N]
    View<Vec3> solved;                          ///< [vertices] H^-1 D E r [m]
};

/// Numbers of an iteration.
struct PcgScalars {
    double b_square = 0.0, r_square = 0.0; ///< [N^2]
    double rz = 0.0;                       ///< r . P r [J]
    double beta = 0.0;                     ///< [-] of p in its successor
    double step = 0.0;                     ///< [-] along p; 0 where p is no direction of descent
};

/// H [vertices x vertices] as rows of numbers, and what is constant beside it.
struct SystemRows {
    View<const int> first, column;   ///< [vertices + 1], [entries]
    View<const double> value;        ///< [entries] [N/m]
    View<const double> diagonal;     ///< [vertices] D [N/m]
    View<const unsigned char> fixed; ///< [vertices]

    TOILE_HD Vec3 times(int i, View<const Vec3> x) const
    {
        Vec3 sum(0.0, 0.0, 0.0);
        for (int k = first[i]; k < first[i + 1]; ++k)
            sum += value[k] * x[column[k]];
        return sum;
    }
};

/// E = (D + blocks)^-1: 1 / D where nothing is frozen.
struct BlocksInverse {
    View<const int> list_of;     ///< [vertices] as DeviceActiveSet::Frozen's
    View<const Mat3> inverse;    ///< [lists]
    View<const double> diagonal; ///< [vertices]

    TOILE_HD Vec3 operator()(int i, const Vec3& r) const
    {
        return list_of[i] > 0 ? Vec3(inverse[list_of[i] - 1] * r) : Vec3(r / diagonal[i]);
    }
};

/// Inverts the block of list k.
struct InvertBlock {
    View<const int> vertices; ///< [lists]
    View<const Mat3> blocks;  ///< [lists] [N/m]
    View<const double> diagonal;
    View<Mat3> inverse; ///< [lists] out

    TOILE_HD void operator()(int k) const
    {
        inverse[k] = Mat3(blocks[k] + diagonal[vertices[k]] * Mat3::Identity()).inverse();
    }
};

/// Begins: x = 0, r = b, and the part of P r before H^-1. A term of |b|^2.
struct BeginPcg {
    View<const Vec3> b;
    PcgFields fields;
    BlocksInverse E;

    TOILE_HD double operator()(int i) const
    {
        const Vec3 r = b[i];
        fields.x[i] = fields.p[i] = fields.r_previous[i] = Vec3(0.0, 0.0, 0.0);
        fields.r[i] = r;
        fields.scaled[i] = E.diagonal[i] * E(i, r);
        return r.squaredNorm();
    }
};

struct KeepStart {
    View<PcgScalars> scalars; ///< [1]
    TOILE_HD void operator()(double b_square) const
    {
        PcgScalars all;
        all.b_square = all.r_square = b_square;
        scalars[0] = all;
    }
};

/// Two sums at once.
struct TwoSums {
    double first = 0.0, second = 0.0;
    TOILE_HD TwoSums& operator+=(const TwoSums& other)
    {
        first += other.first;
        second += other.second;
        return *this;
    }
};

/// z = E (r + D H^-1 D E r). Terms of r . z and r_previous . z.
struct FinishPrecondition {
    PcgFields fields;
    BlocksInverse E;

    TOILE_HD TwoSums operator()(int i) const
    {
        const Vec3 r = fields.r[i];
        const Vec3 z = E(i, r + E.diagonal[i] * fields.solved[i]);
        fields.z[i] = z;
        return {r.dot(z), fields.r_previous[i].dot(z)};
    }
};

/// Polak-Ribiere's beta.
struct FindBeta {
    View<PcgScalars> scalars; ///< [1]
    TOILE_HD void operator()(const TwoSums& sums) const
    {
        PcgScalars& all = scalars[0];
        all.beta = all.rz != 0.0 ? (sums.first - sums.second) / all.rz : 0.0;
        all.rz = sums.first;
    }
};

/// p = z + beta p
struct TurnDirection {
    PcgFields fields;
    View<const PcgScalars> scalars;
    TOILE_HD void operator()(int i) const { fields.p[i] = fields.z[i] + scalars[0].beta * fields.p[i]; }
};

/// (H + dH) p; p itself at fixed vertices. Terms of p . (H + dH) p and r . p.
struct MultiplySystem {
    PcgFields fields;
    SystemRows H;
    View<const int> list_of;         ///< [vertices]
    View<const Vec3> frozen_product; ///< [lists] dH p [N]

    TOILE_HD TwoSums operator()(int i) const
    {
        const Vec3 p = fields.p[i];
        Vec3 product = p;
        if (!H.fixed[i]) {
            product = H.times(i, fields.p);
            if (list_of[i] > 0)
                product += frozen_product[list_of[i] - 1];
        }
        fields.product[i] = product;
        return {p.dot(product), p.dot(fields.r[i])};
    }
};

struct FindStep {
    View<PcgScalars> scalars; ///< [1]
    TOILE_HD void operator()(const TwoSums& sums) const
    {
        scalars[0].step = sums.first > 0.0 ? sums.second / sums.first : 0.0;
    }
};

/// Moves along p, and begins the next P r. A term of |r|^2.
struct TakeStep {
    PcgFields fields;
    BlocksInverse E;
    View<const PcgScalars> scalars;

    TOILE_HD double operator()(int i) const
    {
        const double step = scalars[0].step;
        const Vec3 before = fields.r[i], r = before - step * fields.product[i];
        fields.x[i] += step * fields.p[i];
        fields.r_previous[i] = before;
        fields.r[i] = r;
        fields.scaled[i] = E.diagonal[i] * E(i, r);
        return r.squaredNorm();
    }
};

struct KeepResidual {
    View<PcgScalars> scalars; ///< [1]
    TOILE_HD void operator()(double r_square) const { scalars[0].r_square = r_square; }
};

} // namespace toile
