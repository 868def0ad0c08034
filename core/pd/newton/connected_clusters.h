#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/pd/newton/connected_groups.h"
#include "core/quadrature/clusters/cluster_tree.h"

namespace toile {

/// Clusters of up to 64 vertices, on which coarse spaces have affine functions. Each is connected: those of a
/// ClusterTree, which are near each other in space, may hold pieces of several branches or folds, on which no
/// affine field is right. Such pieces are clusters of their own here, and small ones part of a neighbour that
/// has room.
/// Components of fewer vertices than a leaf of the tree have none.
struct ConnectedClusters {
    static constexpr int kSize = 64; ///< vertices

    /// @param points  [vertices] undeformed positions [m]
    /// @param links  between vertices
    /// @param excluded  [vertices] 1: has no cluster
    ConnectedClusters(View<const EmbeddedPoint> points, const Links& links,
                      View<const unsigned char> excluded, Extent extent);

    /// Clusters of one component follow each other. Labels are the numbers of a component's tree clusters,
    /// ascending: pieces of one share its number.
    Groups groups;
    std::vector<int> first_of_component{0}; ///< [components with clusters + 1]
    std::vector<int> others;                ///< vertices without a cluster

    int count() const { return groups.count(); }

    /// [clusters] ascending
    std::vector<std::vector<int>> vertices() const;
};

/// Orthonormal functions on vertices that span 1 and the coordinates along the axes of their extent
/// [vertices x rank_of(extent)]. Those that depend on others, on few vertices or in a plane, are zero.
/// @param points  [n] undeformed positions [m]
/// @param vertices  at least one
Eigen::MatrixXd affine_functions(View<const EmbeddedPoint> points, View<const int> vertices, Extent extent);

} // namespace toile
