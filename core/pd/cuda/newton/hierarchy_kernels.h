#pragma once

/// Kernels of DeviceHierarchy: assembly of the coarse matrices, their inverses, and their application.

#include "core/compute/team.h"
#include "core/pd/cuda/newton/cluster_hierarchy.h"
#include "core/pd/cuda/newton/hessian_kernels.h"

namespace toile {

/// ClusterHierarchy as kernels read it.
struct HierarchyView {
    static constexpr int kFunctions = ClusterHierarchy::kFunctions;
    static constexpr int kUnknowns = 3 * kFunctions; ///< of a cluster: function by function, x, y, z
    static constexpr int kBlock = ClusterHierarchy::kChildren * kUnknowns; ///< unknowns of a block
    static constexpr int kPanel = kUnknowns * kBlock;                      ///< entries of a cluster's rows
    static constexpr int kMatrix = kBlock * kBlock;

    /// See ClusterHierarchy::Level.
    struct Level {
        View<const int> cluster_of, first_of_cluster, end_of_cluster, block_of, slot_of, first_of_block;
        View<const ClusterHierarchy::Transfer> transfer;
        int first_item = 0; ///< number of its first block among those of all levels
    };

    View<const int> first_vertex, vertices; ///< [clusters of level 0 + 1], [vertices]
    View<const int> cluster_of;             ///< [vertices]
    View<const PaddedVec3> functions;       ///< [vertices] of level 0; zero where fixed
    View<const int> level_of_item;          ///< [blocks of all levels]
    int level_count = 0;
    Level levels[ClusterHierarchy::kMaxLevels];

    TOILE_HD int cluster_count() const { return first_vertex.size() - 1; }

    /// Function b of the cluster of a level, at a vertex below it in cluster c of level 0.
    TOILE_HD float function(const Level& level, int c, int vertex, int b) const
    {
        const auto& T = level.transfer[c].entry;
        const PaddedVec3 f = functions[vertex];
        return T[0][b] * f[0] + T[1][b] * f[1] + T[2][b] * f[2];
    }
};

/// Rows of a cluster of level 0 in the coarse matrices of all levels: its part of
///
///   K_ab = sum_ij f_a(i) f_b(j) K_ij
///
/// for the cluster above it and the clusters of the same block. Of the Hessian's differences only what
/// leaves a cluster acts on its constants: no stiff blocks cancel there.
struct AssembleClusters {
    static constexpr int kSize = ClusterHierarchy::kClusterSize, kFunctions = HierarchyView::kFunctions;
    static constexpr int kThreads = kSize * kFunctions; ///< one for a vertex and a function
    static constexpr int kStride = kSize + 1;
    static constexpr int kProducts = HierarchyView::kUnknowns * kFunctions; ///< of a vertex
    static constexpr int kPairs = HierarchyView::kUnknowns * HierarchyView::kUnknowns;
    static constexpr std::size_t kBytes = sizeof(double) * (kProducts * kStride + kPairs) +
                                          sizeof(float) * kFunctions * kSize + sizeof(unsigned);

    HierarchyView clusters;
    SlicedHessian hessian;
    FrozenTerms terms;
    View<float> matrices; ///< [blocks of level 0][kMatrix] zeros, out
    View<float> panels;   ///< [levels above 0][clusters of level 0][kPanel] zeros, out

    template <typename Block>
    TOILE_HD void operator()(int item, const Block& block) const
    {
        const int c = item % clusters.cluster_count(), number = item / clusters.cluster_count();
        const HierarchyView::Level& level = clusters.levels[number];
        const int own = level.cluster_of[c];
        if (own < 0)
            return;
        double* const products = static_cast<double*>(block.memory);
        double* const halves = products + kProducts * kStride;
        float* const function = reinterpret_cast<float*>(halves + kPairs);
        unsigned* const coupled = reinterpret_cast<unsigned*>(function + kFunctions * kSize);

        const int row = block.thread % kSize, b = block.thread / kSize;
        const int first = clusters.first_vertex[c], count = clusters.first_vertex[c + 1] - first;
        const int v = row < count ? clusters.vertices[first + row] : -1;
        function[b * kSize + row] = v >= 0 ? clusters.function(level, c, v, b) : 0.0F;
        if (block.thread == 0)
            *coupled = 1U << level.slot_of[own];
        block.wait();
        if (v >= 0 && b == 0)
            note(find_coupled(level, own, v), coupled);
        block.wait();
        const unsigned slots = *coupled;
        for (int slot = 0; slot < ClusterHierarchy::kChildren; ++slot) {
            if ((slots >> slot & 1U) == 0U)
                continue;
            const Eigen::Matrix3d sum = v >= 0 ? row_sum(level, own, slot, v, b, function[b * kSize + row])
                                               : Eigen::Matrix3d(Eigen::Matrix3d::Zero());
            for (int k = 0; k < 9; ++k)
                products[(9 * b + k) * kStride + row] = sum(k / 3, k % 3);
            block.wait();
            const int pair = block.thread % kPairs, half = block.thread / kPairs;
            const int a = pair / 27, alpha = pair / 9 % 3, of = pair % 9;
            double entry = 0.0;
            if (half < 2) {
                const double* const column = products + (9 * (of / 3) + 3 * alpha + of % 3) * kStride;
                for (int k = half * (kSize / 2); k < (half + 1) * (kSize / 2); ++k)
                    entry += double(function[a * kSize + k]) * column[k];
                if (half == 1)
                    halves[pair] = entry;
            }
            block.wait();
            if (half == 0)
                store(number, level, c, own, 3 * a + alpha, HierarchyView::kUnknowns * slot + of,
                      float(entry + halves[pair]));
            block.wait();
        }
    }

private:
    /// Slot of the cluster above vertex j if it is in the block of cluster `own`; else -1.
    TOILE_HD int slot_of(const HierarchyView::Level& level, int own, int j) const
    {
        const int other = level.cluster_of[clusters.cluster_of[j]];
        return other >= 0 && level.block_of[other] == level.block_of[own] ? level.slot_of[other] : -1;
    }

    /// Slots to which entries of row v belong, as bits.
    TOILE_HD unsigned find_coupled(const HierarchyView::Level& level, int own, int v) const
    {
        unsigned found = 0U;
        const auto add = [&](int j) {
            if (const int slot = slot_of(level, own, j); slot >= 0)
                found |= 1U << slot;
        };
        hessian.for_blocks(v, [&](int j, const Eigen::Matrix3f&) { add(j); });
        hessian.for_scalars(v, [&](int j, float) { add(j); });
        if (const int list = terms.list_of[v]; list >= 0)
            for (int e = 0; e < terms.rows.active_count[list]; ++e) {
                const FrozenRow& term = terms.rows.rows[terms.rows.first[list] + e];
                for (int k = 0; k < 4 && term.vertex[k] >= 0; ++k)
                    add(term.vertex[k]);
            }
        return found;
    }

    TOILE_HD static void note(unsigned bits, unsigned* all)
    {
#ifdef __CUDA_ARCH__
        atomicOr(all, bits);
#else
        *all |= bits;
#endif
    }

    /// sum_j K_vj f_b(j) over the vertices j in the cluster of `slot`.
    TOILE_HD Eigen::Matrix3d row_sum(const HierarchyView::Level& level, int own, int slot, int v, int b,
                                     float own_function) const
    {
        Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
        const bool is_own = slot == level.slot_of[own];
        if (is_own)
            sum.diagonal().setConstant(hessian.sum[v] * double(own_function));
        const auto factor = [&](int j) {
            const float there = slot_of(level, own, j) == slot
                                    ? clusters.function(level, clusters.cluster_of[j], j, b)
                                    : 0.0F;
            return is_own ? there - own_function : there;
        };
        hessian.for_blocks(v, [&](int j, const Eigen::Matrix3f& K) {
            if (const float f = factor(j); f != 0.0F)
                sum += (f * K).template cast<double>();
        });
        hessian.for_scalars(v, [&](int j, float s) {
            if (const float f = factor(j); f != 0.0F)
                sum.diagonal().array() += double(f * s);
        });
        if (const int list = terms.list_of[v]; list >= 0)
            for (int e = 0; e < terms.rows.active_count[list]; ++e) {
                const FrozenRow& term = terms.rows.rows[terms.rows.first[list] + e];
                float f = 0.0F;
                for (int k = 0; k < 4 && term.vertex[k] >= 0; ++k)
                    if (slot_of(level, own, term.vertex[k]) == slot)
                        f += term.weight[k] *
                             clusters.function(level, clusters.cluster_of[term.vertex[k]], term.vertex[k], b);
                sum += double(term.self_weight * f) * term.stiffness();
            }
        return sum;
    }

    TOILE_HD void store(int number, const HierarchyView::Level& level, int c, int own, int row, int column,
                        float value) const
    {
        if (number == 0)
            matrices[level.block_of[own] * HierarchyView::kMatrix +
                     (HierarchyView::kUnknowns * level.slot_of[own] + row) * HierarchyView::kBlock + column] =
                value;
        else
            panels[((number - 1) * clusters.cluster_count() + c) * HierarchyView::kPanel +
                   row * HierarchyView::kBlock + column] = value;
    }
};

/// Sums the rows of the clusters of level 0 below a cluster of a level above.
struct SumClusters {
    HierarchyView::Level level;
    View<const float> panels; ///< [clusters of level 0][kPanel] of the level
    View<float> matrices;     ///< [blocks of all levels][kMatrix] out

    TOILE_HD void operator()(int i) const
    {
        const int cluster = i / HierarchyView::kPanel, entry = i % HierarchyView::kPanel;
        double sum = 0.0;
        for (int c = level.first_of_cluster[cluster]; c < level.end_of_cluster[cluster]; ++c)
            sum += double(panels[c * HierarchyView::kPanel + entry]);
        const int row = HierarchyView::kUnknowns * level.slot_of[cluster] + entry / HierarchyView::kBlock;
        matrices[(level.first_item + level.block_of[cluster]) * HierarchyView::kMatrix +
                 row * HierarchyView::kBlock + entry % HierarchyView::kBlock] = float(sum);
    }
};

/// Inverts a matrix in place, by Gauss-Jordan elimination in registers after scaling it to a unit diagonal.
/// Functions that depend on others, because vertices are fixed or few, are left out: zero in the inverse.
struct InvertMatrix {
    static constexpr int kTile = 6, kTiles = HierarchyView::kBlock / kTile;
    static constexpr int kThreads = kTiles * kTiles;
    static constexpr int kSize = HierarchyView::kBlock;
    static constexpr std::size_t kBytes = sizeof(double) * 5 * kSize;

    /// Smallest pivot [-] that is not rounding error of the entries.
    static constexpr double kDependent = 1e-6;

    View<float> matrices;

    template <typename Block>
    TOILE_HD void operator()(int item, const Block& block) const
    {
        double* const scale = static_cast<double*>(block.memory);
        double* const rows = scale + kSize; // two of them, by turns
        double* const columns = rows + 2 * kSize;
        float* const M = matrices.data() + std::size_t(item) * HierarchyView::kMatrix;
        const int ty = block.thread / kTiles, tx = block.thread % kTiles;
        for (int k = block.thread; k < kSize; k += kThreads) {
            const float diagonal = M[k * kSize + k];
            scale[k] = diagonal > 0.0F ? 1.0 / std::sqrt(double(diagonal)) : 0.0;
        }
        block.wait();
        double a[kTile][kTile];
        for (int i = 0; i < kTile; ++i)
            for (int j = 0; j < kTile; ++j) {
                const int r = ty * kTile + i, s = tx * kTile + j;
                a[i][j] = 0.5 * (double(M[r * kSize + s]) + double(M[s * kSize + r])) * scale[r] * scale[s];
            }
        for (int tile = 0; tile < kTiles; ++tile)
            for (int k = 0; k < kTile; ++k)
                eliminate(block, tile, k, ty, tx, rows + (k & 1) * kSize, columns + (k & 1) * kSize, a);
        block.wait(); // all have read M
        for (int i = 0; i < kTile; ++i)
            for (int j = 0; j < kTile; ++j) {
                const int r = ty * kTile + i, s = tx * kTile + j;
                M[r * kSize + s] = float(a[i][j] * scale[r] * scale[s]);
            }
    }

private:
    template <typename Block>
    TOILE_HD static void eliminate(const Block& block, int tile, int k, int ty, int tx, double* row,
                                   double* column, double (&a)[kTile][kTile])
    {
        // The index k of a must be known at compile time, or a leaves the registers: hence the loops.
        for (int i = 0; i < kTile; ++i)
            if (ty == tile && i == k)
                for (int j = 0; j < kTile; ++j)
                    row[tx * kTile + j] = a[i][j];
        for (int j = 0; j < kTile; ++j)
            if (tx == tile && j == k)
                for (int i = 0; i < kTile; ++i)
                    column[ty * kTile + i] = a[i][j];
        block.wait();
        const double pivot = row[tile * kTile + k];
        const double inverse = pivot > kDependent ? 1.0 / pivot : 0.0;
        double r[kTile], q[kTile];
        for (int j = 0; j < kTile; ++j)
            r[j] = row[tx * kTile + j];
        for (int i = 0; i < kTile; ++i)
            q[i] = column[ty * kTile + i] * inverse;
        for (int j = 0; j < kTile; ++j)
            if (tx == tile && j == k) {
                r[j] = 1.0;
                for (int i = 0; i < kTile; ++i)
                    a[i][j] = 0.0;
            }
        for (int i = 0; i < kTile; ++i)
            if (ty == tile && i == k)
                q[i] = 0.0;
        for (int i = 0; i < kTile; ++i)
            for (int j = 0; j < kTile; ++j)
                a[i][j] -= q[i] * r[j];
        for (int i = 0; i < kTile; ++i)
            if (ty == tile && i == k)
                for (int j = 0; j < kTile; ++j)
                    a[i][j] = r[j] * inverse;
    }
};

/// Products of the blocks' inverses with a restricted field. Blocks of levels above 0 restrict it themselves
/// from that of level 0.
struct MultiplyInverses {
    static constexpr int kParts = 3; ///< items of a block: each has a third of its rows
    static constexpr int kRows = HierarchyView::kBlock / kParts;
    static constexpr int kGroups = 24; ///< of threads that share four rows
    static constexpr int kThreads = kGroups * kRows / 4;
    static constexpr int kSize = HierarchyView::kBlock;
    static constexpr int kColumns = kSize / kGroups; ///< of a group
    static constexpr std::size_t kBytes = sizeof(float) * (kSize + kThreads + kGroups * kRows);

    HierarchyView clusters;
    View<const float> inverses;     ///< [blocks][kMatrix] symmetric
    View<const float> restricted;   ///< [clusters of level 0][kUnknowns]
    View<float> solution;           ///< [kUnknowns x clusters of all levels] out, levels one after the other
    View<const int> first_of_level; ///< [levels] clusters before them

    /// The inverse, which does not change.
    struct Prologue {
        Floats<4> part[kColumns];
    };
    template <typename Block>
    TOILE_HD Prologue prologue(int item, const Block& block) const
    {
        Prologue local;
        const int rows = block.thread % (kRows / 4), group = block.thread / (kRows / 4);
        const float* const M = inverses.data() + std::size_t(item / kParts) * HierarchyView::kMatrix +
                               item % kParts * kRows + 4 * rows;
        for (int k = 0; k < kColumns; ++k)
            local.part[k] = load_as<Floats<4>>(M + std::size_t(group + kGroups * k) * kSize);
        return local;
    }

    template <typename Block>
    TOILE_HD void operator()(int item, const Block& block) const
    {
        (*this)(item, block, prologue(item, block));
    }
    template <typename Block>
    TOILE_HD void operator()(int item, const Block& block, const Prologue& local) const
    {
        float* const x = static_cast<float*>(block.memory);
        float* const parts = x + kSize;
        float* const sums = parts + kThreads;
        const int number = clusters.level_of_item[item / kParts];
        const HierarchyView::Level& level = clusters.levels[number];
        const int of_level = item / kParts - level.first_item;
        const int first = level.first_of_block[of_level];
        const int count = HierarchyView::kUnknowns * (level.first_of_block[of_level + 1] - first);
        restrict_to(block, number, level, first, count, x, parts);

        const int rows = block.thread % (kRows / 4), group = block.thread / (kRows / 4);
        Floats<4> sum(0.0F);
        for (int k = 0; k < kColumns; ++k)
            sum += x[group + kGroups * k] * local.part[k];
        for (int k = 0; k < 4; ++k)
            sums[group * kRows + 4 * rows + k] = sum[k];
        block.wait();
        const int row = item % kParts * kRows + block.thread;
        if (block.thread >= kRows || row >= count)
            return;
        float total = 0.0F;
        for (int g = 0; g < kGroups; ++g)
            total += sums[g * kRows + block.thread];
        solution[HierarchyView::kUnknowns * (first_of_level[number] + first) + row] = total;
    }

private:
    /// Restricts the field to a block: x [kSize], zeros beyond `count`.
    template <typename Block>
    TOILE_HD void restrict_to(const Block& block, int number, const HierarchyView::Level& level, int first,
                              int count, float* x, float* parts) const
    {
        for (int k = block.thread; k < kSize; k += kThreads)
            x[k] = number == 0 && k < count ? restricted[HierarchyView::kUnknowns * first + k] : 0.0F;
        block.wait();
        if (number == 0)
            return;
        // Several threads for each unknown, each for some of the clusters below.
        const int sharing = kThreads / count, unknown = block.thread % count, share = block.thread / count;
        float sum = 0.0F;
        if (share < sharing) {
            const int cluster = first + unknown / HierarchyView::kUnknowns;
            const int b = unknown % HierarchyView::kUnknowns / 3, alpha = unknown % 3;
            for (int c = level.first_of_cluster[cluster] + share; c < level.end_of_cluster[cluster];
                 c += sharing) {
                const auto& T = level.transfer[c].entry;
                const float* const of = restricted.data() + HierarchyView::kUnknowns * c + alpha;
                sum += T[0][b] * of[0] + T[1][b] * of[3] + T[2][b] * of[6];
            }
        }
        parts[block.thread] = sum;
        block.wait();
        if (block.thread < count) {
            float total = 0.0F;
            for (int k = 0; k < sharing; ++k)
                total += parts[k * count + block.thread];
            x[block.thread] = total;
        }
        block.wait();
    }
};

/// Restriction of a field to a cluster of level 0, and prolongation, by a block of threads.
struct ClusterFields {
    HierarchyView clusters;
    View<float> restricted;         ///< see MultiplyInverses
    View<const float> solution;     ///< likewise
    View<const int> first_of_level; ///< likewise

    /// Coefficients of the functions at a cluster's vertices: the sum of all levels.
    struct Coefficients {
        float of[HierarchyView::kFunctions][3];

        TOILE_HD PaddedVec3 at(const PaddedVec3& functions) const
        {
            PaddedVec3 value(0.0F);
            for (int k = 0; k < 3; ++k)
                value.value[k] = functions[0] * of[0][k] + functions[1] * of[1][k] + functions[2] * of[2][k];
            return value;
        }
    };
    TOILE_HD Coefficients coefficients(int c) const
    {
        Coefficients sum = {};
        for (int number = 0; number < clusters.level_count; ++number) {
            const HierarchyView::Level& level = clusters.levels[number];
            const int cluster = level.cluster_of[c];
            if (cluster < 0)
                continue;
            const auto& T = level.transfer[c].entry;
            const float* const y =
                solution.data() + HierarchyView::kUnknowns * (first_of_level[number] + cluster);
            for (int a = 0; a < 3; ++a)
                for (int k = 0; k < 3; ++k)
                    sum.of[a][k] += T[a][0] * y[k] + T[a][1] * y[3 + k] + T[a][2] * y[6 + k];
        }
        return sum;
    }

    static constexpr int kThreads = ClusterHierarchy::kClusterSize; ///< of a block: one for a vertex
    static constexpr std::size_t kBytes = sizeof(float) * HierarchyView::kUnknowns * (kThreads / kWarp);

    /// Vertex of a thread of cluster c, -1: none.
    TOILE_HD int vertex(int c, int thread) const
    {
        const int k = clusters.first_vertex[c] + thread;
        return k < clusters.first_vertex[c + 1] ? clusters.vertices[k] : -1;
    }

    /// Restricts the field, whose value at vertex i belongs to this thread, to cluster c.
    template <typename Block>
    TOILE_HD void restrict_from(int c, const Block& block, int i, const PaddedVec3& value) const
    {
        float* const of_warps = static_cast<float*>(block.memory);
        const Team team{block.thread % kWarp};
        const PaddedVec3 functions = i >= 0 ? clusters.functions[i] : PaddedVec3(0.0F);
        for (int k = 0; k < HierarchyView::kUnknowns; ++k) {
            const float sum = team.sum(1, functions[k / 3] * value[k % 3]);
            if (team.thread == 0)
                of_warps[block.thread / kWarp * HierarchyView::kUnknowns + k] = sum;
        }
        block.wait();
        if (block.thread >= HierarchyView::kUnknowns)
            return;
        float total = 0.0F;
        for (int w = 0; w < kThreads / kWarp; ++w)
            total += of_warps[w * HierarchyView::kUnknowns + block.thread];
        restricted[HierarchyView::kUnknowns * c + block.thread] = total;
    }
};

} // namespace toile
