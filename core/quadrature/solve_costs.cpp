#include "core/quadrature/solve_costs.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <vector>

#include "core/compute/parallel.h"
#include "core/linear/inverse_columns.h"
#include "core/quadrature/clusters/gather_leaf.h"

namespace toile {

namespace {

/// Ratio of the whole application to its second pass [-]; the rest is the moments.
constexpr double kMoments = 1.1;

/// Numbers per node that are read from near nodes, independent of the size; the others belong to clusters.
/// Counted on grids of 5 000 to 22 500 nodes.
constexpr double kNearGathers = 38.0;

/// Ratio of the whole build to its columns of the inverse [-]; the rest is lists and weights. 1.4 to 1.7 on
/// those grids.
constexpr double kLists = 1.5;

/// [bytes] Limit of the weights that are read; larger tables are extrapolated. Exceeds the caches of most
/// machines, as the whole table would.
constexpr double kMaxBytes = 64e6;

constexpr int kRepeats = 5; ///< of a timing

template <typename Work>
double seconds_of(const Work& work)
{
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Minimum of kRepeats timings: interruptions only add time.
template <typename Work>
double min_seconds_of(const Work& work)
{
    double min_seconds = std::numeric_limits<double>::infinity();
    for (int repeat = 0; repeat < kRepeats; ++repeat)
        min_seconds = std::min(min_seconds, seconds_of(work));
    return min_seconds;
}

double direct_seconds(const SupernodalFactor& factor)
{
    const std::vector<Vec3> b(factor.permutation.size(), Vec3::Ones());
    std::vector<Vec3> x(b.size());
    return min_seconds_of([&] { factor.solve(b, x); });
}

/// The first `leaves` lists of a table with `all_leaves`: near nodes, and clusters spread over all of them.
KernelTable table_of_expected_shape(int leaves, int all_leaves, double gathers)
{
    KernelTable table;
    const int near = int(std::lround(kNearGathers / ClusterTree::kLeaf));
    const int far = int(std::lround(std::max(gathers - kNearGathers, 0.0) / table.rank));
    for (int leaf = 0; leaf <= leaves; ++leaf) {
        table.near_first.push_back(leaf * near);
        table.far_first.push_back(leaf * far);
    }
    for (int e = 0; e < leaves * near; ++e)
        table.near_leaf.push_back((e / near + e % near) % all_leaves);
    for (int e = 0; e < leaves * far; ++e)
        table.far_cluster.push_back(int(long(e) * 7 % (2L * all_leaves)));
    table.near_weights.assign(table.near_leaf.size() * KernelTable::kNearWeights, 1e-3F);
    table.far_weights.assign(table.far_cluster.size() * table.rank * KernelTable::kTargets, 1e-3F);
    return table;
}

double expected_quadrature_seconds(int n)
{
    constexpr int kRank = rank_of(Extent::Surface);
    const double gathers = expected_gathers(n);
    const int all_leaves = (n + ClusterTree::kLeaf - 1) / ClusterTree::kLeaf;
    const double leaf_bytes = gathers * KernelTable::kTargets * sizeof(float);
    const int leaves = std::min(all_leaves, int(kMaxBytes / leaf_bytes));
    const KernelTable table = table_of_expected_shape(leaves, all_leaves, gathers);

    // Twice as many clusters as leaves: the tree is binary.
    const size_t slots = size_t(all_leaves) * ClusterTree::kLeaf;
    const std::vector<Eigen::Vector3f> sources(slots, Eigen::Vector3f::Ones()),
        moments(size_t(kRank) * 2 * all_leaves, Eigen::Vector3f::Ones());
    std::vector<int> nodes(slots);
    for (int slot = 0; slot < int(slots); ++slot)
        nodes[slot] = slot < n ? slot : -1;
    std::vector<Vec3> x(n);
    const GatherLeaf<kRank> gather{table.view(), sources, moments, nodes, x};
    const double seconds =
        min_seconds_of([&] { parallel_for(kCpu, "quadrature/gather", leaves, gather, kLeafGrain); });
    return kMoments * seconds * all_leaves / leaves;
}

double expected_build_seconds(const SupernodalFactor& factor)
{
    constexpr int kColumns = InverseColumns::kColumns;
    const int n = int(factor.permutation.size());
    const InverseColumns inverse(factor);
    std::vector<int> columns;
    for (int k = n / 2; k < std::min(n, n / 2 + kColumns); ++k)
        columns.push_back(factor.permutation[k]);
    InverseColumns::Block block(n);
    const double seconds = seconds_of([&] { inverse.solve(columns, block); });
    return kLists * seconds * n / kColumns;
}

} // namespace

double expected_gathers(int vertex_count) { return 168.0 * std::pow(1e-4 * vertex_count, 0.215); }

SolveCosts expected_costs(const SupernodalFactor& factor)
{
    Stages unrecorded; // the run's counters count only the run's solves
    const Stages::Activate activate(unrecorded);
    return {direct_seconds(factor), expected_quadrature_seconds(int(factor.permutation.size())),
            expected_build_seconds(factor)};
}

SolveCosts measured_costs(const SupernodalFactor& factor, const QuadratureOperator& quadrature)
{
    Stages unrecorded;
    const Stages::Activate activate(unrecorded);
    const std::vector<Vec3> b(factor.permutation.size(), Vec3::Ones());
    std::vector<Vec3> x(b.size());
    return {direct_seconds(factor), min_seconds_of([&] { quadrature.solve(b, x); }), 0.0};
}

} // namespace toile
