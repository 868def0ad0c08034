#pragma once

/// Kernels of DeviceHierarchy: assembly of the coarse matrices, and application of their inverses.

#include <array>

#include "core/compute/team.h"
#include "core/linear/cuda/batched_inverses_kernels.h"
#include "core/pd/cuda/newton/cluster_hierarchy.h"
#include "core/pd/cuda/newton/hessian_kernels.h"

namespace toile {

/// ClusterHierarchy as kernels read it, and the matrices that are inverted: those of the blocks, then those
/// of the components with regions.
struct HierarchyView {
    static constexpr int kMaxFunctions = ClusterHierarchy::kMaxFunctions;
    static constexpr int kMaxUnknowns = 3 * kMaxFunctions;

    int functions_of_cluster;
    View<const int> first_vertex, vertices;      ///< [clusters + 1], [vertices]
    View<const int> cluster_of;                  ///< [vertices]
    View<const PaddedVec3> functions;            ///< [vertices]; zero where fixed
    View<const int> first_neighbour, neighbours; ///< [clusters + 1]
    View<const int> first_member, first_copy;    ///< [blocks + 1], [clusters + 1]
    View<const ClusterHierarchy::Member> members;
    View<const ClusterHierarchy::Copy> copies;
    View<const int> first_region, component_of;       ///< [components + 1], [regions]
    View<const int> region_of;                        ///< [clusters]
    View<const ClusterHierarchy::Transfer> transfers; ///< [clusters]
    View<const ClusterHierarchy::Range> clusters_of_region;
    MatrixBatch matrices;

    TOILE_HD int unknowns() const { return 3 * functions_of_cluster; } ///< function by function, x, y, z
    TOILE_HD int pairs() const { return unknowns() * unknowns(); }
    TOILE_HD int cluster_count() const { return first_vertex.size() - 1; }
    TOILE_HD int block_count() const { return first_member.size() - 1; }

    TOILE_HD bool are_neighbours(int c, int d) const
    {
        for (int at = first_neighbour[c]; at < first_neighbour[c + 1]; ++at)
            if (neighbours[at] == d)
                return true;
        return false;
    }

    /// Vertex of a thread of cluster c, -1: none.
    TOILE_HD int vertex(int c, int thread) const
    {
        const int k = first_vertex[c] + thread;
        return k < first_vertex[c + 1] ? vertices[k] : -1;
    }
};

/// Couplings of a cluster with its neighbours,
///
///   K_ab = sum_ij f_a(i) f_b(j) K_ij,
///
/// also in the matrices of its blocks. Of the Hessian's differences only what leaves a cluster acts on its
/// constants: no stiff blocks cancel there. Contact between clusters that are no neighbours acts on each as
/// contact with something fixed.
struct AssembleClusters {
    static constexpr int kSize = ClusterHierarchy::kClusterSize;
    static constexpr int kMaxFunctions = HierarchyView::kMaxFunctions;
    static constexpr int kNeighbours = 2; ///< at a time; a thread for each of them and a vertex
    static constexpr int kThreads = kSize * kNeighbours;
    static constexpr int kStride = kSize + 1;
    static constexpr int kProducts = 9 * kMaxFunctions; ///< of a vertex
    static constexpr std::size_t kBytes =
        sizeof(double) * kNeighbours * kProducts * kStride + sizeof(float) * kMaxFunctions * kSize;

    HierarchyView clusters;
    SlicedHessian hessian;
    FrozenTerms terms;
    View<double> couplings; ///< [neighbours][pairs of unknowns] out [N/m]

    template <typename Block>
    TOILE_HD void operator()(int c, const Block& block) const
    {
        double* const products = static_cast<double*>(block.memory);
        float* const function = reinterpret_cast<float*>(products + kNeighbours * kProducts * kStride);
        const int row = block.thread % kSize, group = block.thread / kSize;
        const int v = clusters.vertex(c, row), pairs = clusters.pairs();
        const PaddedVec3 own = v >= 0 ? clusters.functions[v] : PaddedVec3(0.0F);
        if (group == 0)
            for (int a = 0; a < kMaxFunctions; ++a)
                function[a * kSize + row] = own[a];
        const int end = clusters.first_neighbour[c + 1];
        for (int first = clusters.first_neighbour[c]; first < end; first += kNeighbours) {
            RowSums sums;
            if (v >= 0 && first + group < end)
                sums = row_sums(v, own, c, clusters.neighbours[first + group]);
            for (int k = 0; k < kProducts; ++k)
                products[(group * kProducts + k) * kStride + row] = sums.of[k / 9](k / 3 % 3, k % 3);
            block.wait();
            for (int k = block.thread; k < kNeighbours * pairs; k += kThreads)
                if (first + k / pairs < end)
                    store(c, first + k / pairs, k % pairs,
                          product(function, products + k / pairs * kProducts * kStride, k % pairs));
            block.wait();
        }
    }

private:
    /// sum_j K_vj f_b(j) over the vertices j of a cluster, for each function b.
    struct RowSums {
        Mat3 of[kMaxFunctions];
        TOILE_HD RowSums()
        {
            for (Mat3& sum : of)
                sum.setZero();
        }
    };
    TOILE_HD RowSums row_sums(int v, const PaddedVec3& own, int c, int neighbour) const
    {
        RowSums sums;
        const bool is_own = neighbour == c;
        if (is_own)
            for (int b = 0; b < kMaxFunctions; ++b)
                sums.of[b].diagonal().setConstant(hessian.sum[v] * double(own[b]));
        const auto change = [&](int j, const auto& add) {
            const bool is_there = clusters.cluster_of[j] == neighbour;
            if (!is_there && !is_own)
                return;
            const PaddedVec3 there = is_there ? clusters.functions[j] : PaddedVec3(0.0F);
            for (int b = 0; b < kMaxFunctions; ++b)
                add(sums.of[b], double(is_own ? there[b] - own[b] : there[b]));
        };
        hessian.for_blocks(v, [&](int j, const Eigen::Matrix3f& K) {
            change(j, [&](Mat3& sum, double f) { sum += f * K.template cast<double>(); });
        });
        hessian.for_scalars(v, [&](int j, float s) {
            change(j, [&](Mat3& sum, double f) { sum.diagonal().array() += f * double(s); });
        });
        if (const int list = terms.list_of[v]; list >= 0)
            for (int e = 0; e < terms.rows.active_count[list]; ++e)
                add_term(terms.rows.rows[terms.rows.first[list] + e], c, neighbour, sums);
        return sums;
    }
    TOILE_HD void add_term(const FrozenRow& term, int c, int neighbour, RowSums& sums) const
    {
        PaddedVec3 f(0.0F);
        bool is_there = false;
        for (int k = 0; k < 4 && term.vertex[k] >= 0; ++k)
            if (clusters.cluster_of[term.vertex[k]] == neighbour) {
                f += term.weight[k] * clusters.functions[term.vertex[k]];
                is_there = true;
            }
        if (!is_there || (neighbour != c && !are_neighbours(term.vertex)))
            return;
        for (int b = 0; b < kMaxFunctions; ++b)
            sums.of[b] += double(term.self_weight * f[b]) * term.stiffness();
    }
    /// True if the clusters of all vertices of a term are neighbours of each other: only then its couplings
    /// are kept, all of them or none, so that the matrices stay positive semi-definite.
    TOILE_HD bool are_neighbours(const std::array<int, 4>& vertex) const
    {
        for (int k = 0; k < 4 && vertex[k] >= 0; ++k)
            for (int l = 0; l < k; ++l)
                if (!clusters.are_neighbours(clusters.cluster_of[vertex[k]], clusters.cluster_of[vertex[l]]))
                    return false;
        return true;
    }

    /// Entry `pair` of a coupling: sum over the cluster's vertices of function times row sum.
    TOILE_HD double product(const float* function, const double* products, int pair) const
    {
        const int row = pair / clusters.unknowns(), column = pair % clusters.unknowns();
        const float* const f = function + row / 3 * kSize;
        const double* const sums = products + (9 * (column / 3) + 3 * (row % 3) + column % 3) * kStride;
        double sum = 0.0;
        for (int k = 0; k < kSize; ++k)
            sum += double(f[k]) * sums[k];
        return sum;
    }
    TOILE_HD void store(int c, int at, int pair, double value) const
    {
        const int unknowns = clusters.unknowns(), neighbour = clusters.neighbours[at];
        couplings[at * clusters.pairs() + pair] = value;
        for (int k = clusters.first_copy[c]; k < clusters.first_copy[c + 1]; ++k)
            for (int l = clusters.first_copy[neighbour]; l < clusters.first_copy[neighbour + 1]; ++l) {
                const ClusterHierarchy::Copy own = clusters.copies[k], other = clusters.copies[l];
                if (own.block == other.block)
                    clusters.matrices.entry(own.block, unknowns * own.place + pair / unknowns,
                                            unknowns * other.place + pair % unknowns) = value;
            }
    }
};

/// Rows of a region in the matrix of its component: sums of its clusters' couplings.
struct AssembleRegions {
    static constexpr int kMaxPairs = HierarchyView::kMaxUnknowns * HierarchyView::kMaxUnknowns;
    static constexpr int kThreads = (kMaxPairs + kWarp - 1) / kWarp * kWarp; ///< one for an entry

    HierarchyView clusters;
    View<const double> couplings; ///< see AssembleClusters

    template <typename Block>
    TOILE_HD void operator()(int region, const Block& block) const
    {
        const int functions = clusters.functions_of_cluster, unknowns = clusters.unknowns();
        if (block.thread >= clusters.pairs())
            return;
        const int component = clusters.component_of[region], first = clusters.first_region[component];
        const int row = block.thread / unknowns, column = block.thread % unknowns;
        const ClusterHierarchy::Range range = clusters.clusters_of_region[region];
        for (int c = range.first; c < range.end; ++c)
            for (int at = clusters.first_neighbour[c]; at < clusters.first_neighbour[c + 1]; ++at) {
                const int neighbour = clusters.neighbours[at];
                const auto& left = clusters.transfers[c].entry;
                const auto& right = clusters.transfers[neighbour].entry;
                const double* const K = couplings.data() + std::size_t(at) * std::size_t(clusters.pairs());
                double sum = 0.0;
                for (int s = 0; s < functions; ++s)
                    for (int t = 0; t < functions; ++t)
                        sum += double(left[s][row / 3] * right[t][column / 3]) *
                               K[(3 * s + row % 3) * unknowns + 3 * t + column % 3];
                clusters.matrices.entry(clusters.block_count() + component, unknowns * (region - first) + row,
                                        unknowns * (clusters.region_of[neighbour] - first) + column) += sum;
            }
    }
};

/// Products of the inverses with a restricted field, by tile rows.
struct MultiplyInverses {
    static constexpr int kRows = MatrixBatch::kTile;
    static constexpr int kGroups = 24; ///< of threads that share four rows
    static constexpr int kThreads = kGroups * kRows / 4;
    static constexpr int kColumns = 6; ///< of a group, loaded ahead
    static constexpr int kMaxSize = ClusterHierarchy::kMaxUnknowns;
    static_assert(ClusterHierarchy::kMaxBlockClusters * HierarchyView::kMaxUnknowns <= kMaxSize);
    static constexpr std::size_t kBytes = sizeof(float) * (kMaxSize + kGroups * kRows);

    HierarchyView clusters;
    View<const float> restricted, to_regions; ///< see ClusterFields
    View<float> of_copies, of_regions;        ///< [copies], [regions][unknowns] out

    /// The first columns of the inverse, which does not change.
    using Prologue = std::array<Floats<4>, kColumns>;

    template <typename Block>
    TOILE_HD Prologue prologue(int item, const Block& block) const
    {
        return columns_from(item, block.thread, group(block), stride_of(item));
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
        float* const sums = x + kMaxSize;
        const MatrixTile tile = clusters.matrices.tile_rows[item];
        const int stride = stride_of(item), component = tile.matrix - clusters.block_count();
        const int size = component < 0 ? load_block(block, tile.matrix, stride, x)
                                       : load_component(block, component, stride, x);
        block.wait();

        Floats<4> sum(0.0F);
        const auto add = [&](int first, const Prologue& columns) {
            for (int k = 0; k < kColumns; ++k)
                if (const int column = first + kGroups * k; column < stride)
                    sum += x[column] * columns[k];
        };
        add(group(block), local);
        constexpr int kAtOnce = kGroups * kColumns;
        for (int first = group(block) + kAtOnce; first < stride; first += kAtOnce)
            add(first, columns_from(item, block.thread, first, stride));
        for (int k = 0; k < 4; ++k)
            sums[group(block) * kRows + 4 * rows(block.thread) + k] = sum[k];
        block.wait();
        const int row = kRows * tile.row + block.thread;
        if (block.thread >= kRows || row >= size)
            return;
        float total = 0.0F;
        for (int g = 0; g < kGroups; ++g)
            total += sums[g * kRows + block.thread];
        const int unknowns = clusters.unknowns();
        if (component < 0)
            of_copies[unknowns * member(tile.matrix, row / unknowns).copy + row % unknowns] = total;
        else
            of_regions[unknowns * clusters.first_region[component] + row] = total;
    }

private:
    TOILE_HD static int rows(int thread) { return thread % (kRows / 4); }
    template <typename Block>
    TOILE_HD static int group(const Block& block)
    {
        return block.thread / (kRows / 4);
    }
    TOILE_HD int stride_of(int item) const
    {
        return clusters.matrices.matrices[clusters.matrices.tile_rows[item].matrix].stride();
    }
    /// Parts of every kGroups-th column.
    TOILE_HD Prologue columns_from(int item, int thread, int first, int stride) const
    {
        Prologue columns;
        for (int k = 0; k < kColumns; ++k)
            columns[k] = part(item, thread, first + kGroups * k, stride);
        return columns;
    }
    /// Four rows of a column: the inverse is symmetric.
    TOILE_HD Floats<4> part(int item, int thread, int column, int stride) const
    {
        const MatrixTile tile = clusters.matrices.tile_rows[item];
        const float* const inverse =
            clusters.matrices.tile(clusters.matrices.inverses, tile.matrix, 0, tile.row);
        return column < stride ? load_as<Floats<4>>(inverse + column * stride + 4 * rows(thread))
                               : Floats<4>(0.0F);
    }

    /// Field of a block, zero beyond its size, which it returns.
    template <typename Block>
    TOILE_HD int load_block(const Block& block, int matrix, int stride, float* x) const
    {
        const int unknowns = clusters.unknowns();
        const int size = unknowns * (clusters.first_member[matrix + 1] - clusters.first_member[matrix]);
        for (int k = block.thread; k < stride; k += kThreads)
            x[k] =
                k < size ? restricted[unknowns * member(matrix, k / unknowns).cluster + k % unknowns] : 0.0F;
        return size;
    }
    TOILE_HD ClusterHierarchy::Member member(int matrix, int place) const
    {
        return clusters.members[clusters.first_member[matrix] + place];
    }
    template <typename Block>
    TOILE_HD int load_component(const Block& block, int component, int stride, float* x) const
    {
        const int first = clusters.first_region[component], unknowns = clusters.unknowns();
        const int size = unknowns * (clusters.first_region[component + 1] - first);
        for (int k = block.thread; k < stride; k += kThreads)
            x[k] = k < size ? of_region(first + k / unknowns, k % unknowns) : 0.0F;
        return size;
    }
    TOILE_HD float of_region(int region, int unknown) const
    {
        const ClusterHierarchy::Range range = clusters.clusters_of_region[region];
        float sum = 0.0F;
        for (int c = range.first; c < range.end; ++c)
            sum += to_regions[clusters.unknowns() * c + unknown];
        return sum;
    }
};

/// Restriction of a field to a cluster, and prolongation, by a block of threads.
struct ClusterFields {
    static constexpr int kMaxFunctions = HierarchyView::kMaxFunctions;

    HierarchyView clusters;
    View<float> restricted; ///< [clusters][unknowns]
    View<float> to_regions; ///< [clusters][unknowns] what each adds to its region's restriction
    View<const float> of_copies, of_regions; ///< see MultiplyInverses

    /// Coefficients of the functions at a cluster's vertices: the sum of all parts.
    struct Coefficients {
        PaddedVec3 of[kMaxFunctions];

        TOILE_HD PaddedVec3 at(const PaddedVec3& functions) const
        {
            PaddedVec3 value(0.0F);
            for (int a = 0; a < kMaxFunctions; ++a)
                value += functions[a] * of[a];
            return value;
        }
    };
    TOILE_HD Coefficients coefficients(int c) const
    {
        Coefficients sum;
        for (PaddedVec3& coefficient : sum.of)
            coefficient = PaddedVec3(0.0F);
        const int functions = clusters.functions_of_cluster, region = clusters.region_of[c];
        const auto& T = clusters.transfers[c].entry;
        for (int k = clusters.first_copy[c]; k < clusters.first_copy[c + 1]; ++k)
            for (int b = 0; b < kMaxFunctions; ++b)
                if (b < functions)
                    sum.of[b] += load(of_copies, k, b);
        for (int b = 0; b < kMaxFunctions; ++b)
            if (b < functions && region >= 0) {
                const PaddedVec3 y = load(of_regions, region, b);
                for (int a = 0; a < kMaxFunctions; ++a)
                    sum.of[a] += T[a][b] * y;
            }
        return sum;
    }

    static constexpr int kThreads = ClusterHierarchy::kClusterSize; ///< of a block: one for a vertex
    static constexpr int kWarps = kThreads / kWarp;
    static constexpr std::size_t kBytes = sizeof(float) * HierarchyView::kMaxUnknowns * (kWarps + 1);

    /// Restricts the field, whose value at vertex i belongs to this thread, to cluster c.
    template <typename Block>
    TOILE_HD void restrict_from(int c, const Block& block, int i, const PaddedVec3& value) const
    {
        float* const of_warps = static_cast<float*>(block.memory);
        const Team team{block.thread % kWarp};
        const int unknowns = clusters.unknowns();
        const PaddedVec3 functions = i >= 0 ? clusters.functions[i] : PaddedVec3(0.0F);
        for (int b = 0; b < kMaxFunctions; ++b)
            if (b < clusters.functions_of_cluster)
                for (int k = 0; k < 3; ++k) {
                    const float sum = team.sum(1, functions[b] * value[k]);
                    if (team.thread == 0)
                        of_warps[block.thread / kWarp * unknowns + 3 * b + k] = sum;
                }
        block.wait();
        float* const of_cluster = of_warps + kWarps * unknowns;
        if (block.thread < unknowns) {
            float total = 0.0F;
            for (int w = 0; w < kWarps; ++w)
                total += of_warps[w * unknowns + block.thread];
            of_cluster[block.thread] = restricted[unknowns * c + block.thread] = total;
        }
        block.wait();
        if (block.thread < unknowns && clusters.region_of[c] >= 0)
            to_regions[unknowns * c + block.thread] =
                part_of_region(clusters.transfers[c], of_cluster, block.thread);
    }

private:
    /// Unknown of a region that functions of a cluster make.
    TOILE_HD float part_of_region(const ClusterHierarchy::Transfer& transfer, const float* of_cluster,
                                  int unknown) const
    {
        float sum = 0.0F;
        for (int a = 0; a < clusters.functions_of_cluster; ++a)
            sum += transfer.entry[a][unknown / 3] * of_cluster[3 * a + unknown % 3];
        return sum;
    }
    TOILE_HD PaddedVec3 load(View<const float> solution, int of, int b) const
    {
        const float* const y = solution.data() + clusters.unknowns() * of + 3 * b;
        return PaddedVec3(y[0], y[1], y[2], 0.0F);
    }
};

} // namespace toile
