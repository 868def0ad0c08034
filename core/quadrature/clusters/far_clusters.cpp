#include "core/quadrature/clusters/far_clusters.h"

#include <cmath>

namespace toile {

namespace {

constexpr int kLeaf = ClusterTree::kLeaf;

/// Growth of the permitted squared error per level, that is for twice as many nodes [-]. The error of the
/// functions is smooth inside a cluster and jumps at its rim. H weighs the jumps, and the rim grows with the
/// square root of a surface's nodes. At 1 and at 2 the same contraction needs longer lists. A volume's rim
/// grows faster, but with 2^(2/3) large blocks no longer contracted; from 1 to 2^(1/2) volumes show no
/// difference.
constexpr double kGrowth = 1.4142135623730951;

/// Mean of a field over the nodes of every cluster.
std::vector<double> cluster_means(const ClusterTree& tree, View<const double> field)
{
    std::vector<double> sums(tree.cluster_count(), 0.0);
    std::vector<int> counts(tree.cluster_count(), 0);
    for (int slot = 0; slot < tree.nodes().size(); ++slot)
        if (const int v = tree.nodes()[slot]; v >= 0) {
            sums[slot / kLeaf] += field[v];
            ++counts[slot / kLeaf];
        }
    for (int level = 1; level < tree.level_count(); ++level)
        for (int c = 0; c < tree.level_size(level); ++c)
            for (int which = 0; which < 2; ++which)
                if (const int child = tree.child(level, c, which); child >= 0) {
                    sums[tree.first_of_level(level) + c] += sums[child];
                    counts[tree.first_of_level(level) + c] += counts[child];
                }
    for (int id = 0; id < tree.cluster_count(); ++id)
        sums[id] /= counts[id];
    return sums;
}

} // namespace

std::vector<double> far_limits(const ClusterTree& tree, View<const double> diagonal, double tolerance)
{
    std::vector<double> limits = cluster_means(tree, diagonal);
    for (int level = 0; level < tree.level_count(); ++level)
        for (int c = 0; c < tree.level_size(level); ++c) {
            double& limit = limits[tree.first_of_level(level) + c];
            limit = tolerance * tolerance * std::pow(kGrowth, level) / limit;
        }
    return limits;
}

} // namespace toile
