#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/compute/types.h"

namespace toile {

/// Position of a node in a space whose Euclidean distance approximates the distance within the body [m]: the
/// position in a volume, or the point that quadrature2d embeds for a sewn surface. Unused axes are zero.
using EmbeddedPoint = Eigen::Matrix<double, 6, 1>;

/// Dimension of the set of points: determines the number of cluster axes.
enum class Extent { Surface, Volume };

/// Functions on a cluster: 1 and a coordinate along each of its axes.
constexpr int rank_of(Extent extent) { return extent == Extent::Surface ? 3 : 4; }

/// Nodes grouped by bisection across their longest direction, into leaves of exactly kLeaf nodes (the last
/// one may be padded).
// clang-format off
//
//      level 2   |          0          |     1    |        cluster (k, c) holds the leaves
//      level 1   |     0    |    1     |     2    |        [c 2^k, (c + 1) 2^k) that exist:
//      level 0   | 0  |  1  | 2  |  3  | 4  |  5  |        the tree needs no pointers
//
// clang-format on
/// Clusters are numbered level by level, leaves first: children come before their parents, the root is last.
class ClusterTree {
public:
    static constexpr int kLeaf = 8;

    struct Cluster {
        EmbeddedPoint center = EmbeddedPoint::Zero(); ///< mean of its nodes [m]
        double radius = 0.0; ///< [m] of the ball around the centre that contains the nodes
        /// Directions of largest extent, longest first, orthonormal: two on a surface, three in a volume.
        /// Zero if the cluster has no such extent.
        Eigen::Matrix<double, 6, 3> axes = Eigen::Matrix<double, 6, 3>::Zero();
    };

    /// @param points  [n] of all nodes
    /// @param nodes   nodes to group; may be empty
    ClusterTree(View<const EmbeddedPoint> points, std::vector<int> nodes, Extent extent = Extent::Surface);

    Extent extent() const { return extent_; }
    int leaf_count() const { return level_size(0); }
    int cluster_count() const { return first_of_level_.back(); }
    int level_count() const { return int(first_of_level_.size()) - 1; }
    int level_size(int level) const { return first_of_level_[level + 1] - first_of_level_[level]; }
    int first_of_level(int level) const { return first_of_level_[level]; }
    int root() const { return cluster_count() - 1; } ///< -1 without nodes

    /// Child 0 or 1 of cluster c of a level above 0; -1 if there is no second child.
    int child(int level, int c, int which) const
    {
        const int k = 2 * c + which;
        return k < level_size(level - 1) ? first_of_level_[level - 1] + k : -1;
    }

    /// Centre, radius and axes of some nodes.
    /// @param nodes  at least one
    static Cluster measure(View<const EmbeddedPoint> points, View<const int> nodes, Extent extent);

    const Cluster& cluster(int id) const { return clusters_[id]; }

    /// [kLeaf * leaf_count] node of every slot, -1 for padding of the last leaf.
    View<const int> nodes() const { return nodes_; }

private:
    View<const int> nodes_of(int level, int c) const;
    void split(View<const EmbeddedPoint> points, int level, int c);

    Extent extent_;
    std::vector<int> nodes_;
    std::vector<int> first_of_level_; ///< [levels + 1]
    std::vector<Cluster> clusters_;
};

} // namespace toile
