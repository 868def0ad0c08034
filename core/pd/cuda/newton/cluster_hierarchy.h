#pragma once

#include <vector>

#include "core/compute/lanes.h"
#include "core/linear/block_matrix.h"
#include "core/linear/sparse_matrix.h"
#include "core/pd/newton/connected_clusters.h"

namespace toile {

/// Clusters of vertices, nested regions of clusters, and on each of both three or four functions, close to 1
/// and the coordinates along the axes of its extent: the coarse spaces of an additive preconditioner.
/// Clusters are ConnectedClusters of a matrix. Up to 16 of them, connected and near each other, form a
/// *block*. A component of more clusters also has *regions*: connected sets of two or more clusters,
/// as many as max_unknowns() allows, three a function. A solver inverts the couplings within a block, and
/// those between all regions of a component.
class ClusterHierarchy {
public:
    static constexpr int kClusterSize = ConnectedClusters::kSize;
    static constexpr int kBlockClusters = 16; ///< clusters of a block
    static constexpr int kMaxUnknowns = 2304; ///< see max_unknowns()
    static constexpr int kMaxUnknownsOfMany = 768;
    static constexpr int kMaxFunctions = 4;

    /// Functions of a cluster as combinations of those of its region.
    struct Transfer {
        float entry[kMaxFunctions][kMaxFunctions] = {};
    };

    /// Most unknowns of the regions of a component: kMaxUnknowns / cbrt(components), since inverting costs
    /// the cube, and at least kMaxUnknownsOfMany.
    /// @param components  with regions, at least 1
    static int max_unknowns(int components);

    /// @param points  [vertices] undeformed positions
    /// @param blocks, isotropic  patterns that connect vertices, symmetric
    /// @param extent  of the points
    ClusterHierarchy(View<const EmbeddedPoint> points, const BlockMatrix& blocks,
                     const SparseMatrix& isotropic, Extent extent);

    int function_count() const { return rank_of(extent_); }
    int unknown_count() const { return 3 * function_count(); } ///< of a cluster or region

    /// The last clusters may hold vertices of small components, whose functions are zero: they belong to no
    /// block.
    int cluster_count() const { return int(first_vertex_.size()) - 1; }
    const std::vector<int>& first_vertex() const { return first_vertex_; } ///< [clusters + 1] into vertices()
    const std::vector<int>& vertices() const { return vertices_; }
    const std::vector<int>& cluster_of() const { return cluster_of_; }      ///< [vertices]
    const std::vector<PaddedVec3>& functions() const { return functions_; } ///< [vertices] of its cluster

    /// Clusters of blocks that entries couple with a cluster, itself included, ascending.
    const std::vector<int>& first_neighbour() const { return first_neighbour_; } ///< [clusters + 1]
    const std::vector<int>& neighbours() const { return neighbours_; }

    int block_count() const { return int(first_of_block_.size()) - 1; }
    const std::vector<int>& first_of_block() const { return first_of_block_; } ///< [blocks + 1] clusters
    const std::vector<int>& block_of() const { return block_of_; }             ///< [clusters] -1: none

    int region_count() const { return int(clusters_of_region_.size()); }
    int component_count() const { return int(first_region_.size()) - 1; }  ///< with regions
    const std::vector<int>& first_region() const { return first_region_; } ///< [components + 1]
    const std::vector<int>& component_of() const { return component_of_; } ///< [regions]
    const std::vector<int>& region_of() const { return region_of_; }       ///< [clusters] -1: none
    const std::vector<Transfer>& transfers() const { return transfers_; }  ///< [clusters]

    /// Consecutive clusters.
    struct Range {
        int first, end;
    };
    /// [regions]
    const std::vector<Range>& clusters_of_region() const { return clusters_of_region_; }

private:
    void add_cluster(View<const EmbeddedPoint> points, const std::vector<int>& vertices);
    void add_component(View<const EmbeddedPoint> points, View<const std::vector<int>> clusters,
                       const std::vector<int>& order, const std::vector<int>& region,
                       const std::vector<int>& block);
    void find_transfers(View<const EmbeddedPoint> points, int region);
    void add_others(const std::vector<int>& vertices);
    void find_neighbours(const BlockMatrix& blocks, const SparseMatrix& isotropic);

    Extent extent_;
    std::vector<int> first_vertex_{0}, vertices_, cluster_of_;
    std::vector<PaddedVec3> functions_;
    std::vector<int> first_neighbour_, neighbours_;
    std::vector<int> first_of_block_{0}, block_of_;
    std::vector<int> first_region_{0}, component_of_, region_of_;
    std::vector<Transfer> transfers_;
    std::vector<Range> clusters_of_region_;
};

} // namespace toile
