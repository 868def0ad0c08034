#pragma once

#include "core/compute/team.h"
#include "core/pd/cuda/active_set.h"
#include "core/pd/cuda/newton/hessian_entries.h"

namespace toile {

/// Hessian of a step as kernels read it, without the terms of an active set; see HessianPattern.
struct SlicedHessian {
    static constexpr int kBlocksAtOnce = 2, kScalarsAtOnce = 6; ///< entries that a thread loads together

    View<const int> first_block, block_columns;   ///< SlicedPattern
    HessianBlocks blocks;                         ///< by position [N/m]
    View<const int> first_scalar, scalar_columns; ///< SlicedPattern
    View<const float> scalars;                    ///< by position [N/m]
    View<const double> sum;                       ///< [vertices] S [N/m]

    /// Entries of row i: every kWarp-th position from begin to end. Calls visit(column, block or number).
    template <typename Visit>
    TOILE_HD void for_blocks(int i, const Visit& visit) const
    {
        const int slice = i / kWarp, end = first_block[slice + 1];
        for (int k = first_block[slice] + i % kWarp; k < end; k += kWarp)
            visit(block_columns[k], blocks[k]);
    }
    template <typename Visit>
    TOILE_HD void for_scalars(int i, const Visit& visit) const
    {
        const int slice = i / kWarp, end = first_scalar[slice + 1];
        for (int k = first_scalar[slice] + i % kWarp; k < end; k += kWarp)
            visit(scalar_columns[k], scalars[k]);
    }

    /// Row i times x [N], x zero where fixed.
    TOILE_HD PaddedVec3 times(int i, View<const PaddedVec3> x) const { return part_of_row(i, 0, 1, x); }

    /// Part of that product by one of `width` threads, which take the entries by turns.
    TOILE_HD PaddedVec3 part_of_row(int i, int thread, int width, View<const PaddedVec3> x) const
    {
        const PaddedVec3 own = x[i];
        PaddedVec3 product = thread == 0 ? float(sum[i]) * own : PaddedVec3(0.0F);
        const int slice = i / kWarp, first = i % kWarp + thread * kWarp, stride = width * kWarp;
        add_blocks(first_block[slice] + first, first_block[slice + 1], stride, own, x, product);
        add_scalars(first_scalar[slice] + first, first_scalar[slice + 1], stride, own, x, product);
        return product;
    }

private:
    TOILE_HD void add_blocks(int begin, int end, int stride, const PaddedVec3& own, View<const PaddedVec3> x,
                             PaddedVec3& product) const
    {
        for (int first = begin; first < end; first += kBlocksAtOnce * stride) {
            Floats<4> a[kBlocksAtOnce], b[kBlocksAtOnce], move[kBlocksAtOnce];
            float c[kBlocksAtOnce];
            for (int n = 0; n < kBlocksAtOnce; ++n) {
                const int k = first + n * stride;
                const bool exists = k < end;
                move[n] = exists ? x[block_columns[k]] : own;
                a[n] = exists ? blocks.first[k] : Floats<4>(0.0F);
                b[n] = exists ? blocks.second[k] : Floats<4>(0.0F);
                c[n] = exists ? blocks.last[k] : 0.0F;
            }
            for (int n = 0; n < kBlocksAtOnce; ++n) {
                const float u = move[n][0] - own[0], v = move[n][1] - own[1], w = move[n][2] - own[2];
                product.value[0] += a[n][0] * u + a[n][1] * v + a[n][2] * w;
                product.value[1] += a[n][3] * u + b[n][0] * v + b[n][1] * w;
                product.value[2] += b[n][2] * u + b[n][3] * v + c[n] * w;
            }
        }
    }
    TOILE_HD void add_scalars(int begin, int end, int stride, const PaddedVec3& own, View<const PaddedVec3> x,
                              PaddedVec3& product) const
    {
        const PaddedVec3 back = -1.0F * own;
        for (int first = begin; first < end; first += kScalarsAtOnce * stride) {
            PaddedVec3 move[kScalarsAtOnce];
            float value[kScalarsAtOnce];
            for (int n = 0; n < kScalarsAtOnce; ++n) {
                const int k = first + n * stride;
                move[n] = k < end ? x[scalar_columns[k]] : own;
                value[n] = k < end ? scalars[k] : 0.0F;
            }
            for (int n = 0; n < kScalarsAtOnce; ++n) {
                move[n] += back;
                product += value[n] * move[n];
            }
        }
    }
};

/// Terms of an active set in the Hessian; empty views without any.
struct FrozenTerms {
    ListOfVertex list_of;
    FrozenRows rows;
    View<const Mat3> blocks; ///< [lists] [N/m]
    View<const Vec3> product;

    static FrozenTerms of(const DeviceActiveSet::Frozen& frozen)
    {
        return {frozen.list_of, frozen.rows, frozen.blocks, frozen.product};
    }
};

/// Begins a Hessian: its diagonal with the inertia, its scalars with their constant part, its blocks with
/// zero.
struct BeginSum {
    View<const double> inertia;
    View<double> sum;
    TOILE_HD void operator()(int i) const { sum[i] = inertia[i]; }
};
struct BeginScalars {
    View<const float> constant;
    View<float> scalars;
    TOILE_HD void operator()(int k) const { scalars[k] = constant[k]; }
};

} // namespace toile
