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
/// *block*. A component of more clusters also has *regions*: connected sets of two or more clusters, as many
/// as kMaxUnknowns allows, three a function. Where they consist of several blocks, these overlap: a block
/// also has the clusters next to it if that makes 32 at most. So thin parts, which bend where blocks meet,
/// have overlapping blocks. A solver inverts the couplings within a block, and those between all regions of a
/// component.
class ClusterHierarchy {
public:
    static constexpr int kClusterSize = ConnectedClusters::kSize;
    static constexpr int kBlockClusters = 16; ///< of a block, without those next to them
    static constexpr int kMaxBlockClusters = 2 * kBlockClusters;
    static constexpr int kMaxUnknowns = 768; ///< of the regions of a component; inverting costs their cube
    static constexpr int kMaxFunctions = 4;

    /// Cluster in a block. Each of the blocks that hold a cluster has a copy of it.
    struct Member {
        int cluster, copy;
    };
    /// Block that a copy belongs to, and its place among the block's members.
    struct Copy {
        int block, place;
    };

    /// Functions of a cluster as combinations of those of its region.
    struct Transfer {
        float entry[kMaxFunctions][kMaxFunctions] = {};
    };

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

    int block_count() const { return int(first_member_.size()) - 1; }
    const std::vector<int>& first_member() const { return first_member_; } ///< [blocks + 1]
    const std::vector<Member>& members() const { return members_; }        ///< clusters ascending in a block
    const std::vector<int>& first_copy() const { return first_copy_; }     ///< [clusters + 1]
    const std::vector<Copy>& copies() const { return copies_; }            ///< blocks ascending for a cluster

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
    bool is_part_of_region(int first_cluster, int end_cluster) const;
    void find_members();

    Extent extent_;
    std::vector<int> first_vertex_{0}, vertices_, cluster_of_;
    std::vector<PaddedVec3> functions_;
    std::vector<int> first_neighbour_, neighbours_;
    std::vector<int> first_of_block_{0}; ///< [blocks + 1] clusters, without those next to them
    std::vector<int> first_member_{0}, first_copy_{0};
    std::vector<Member> members_;
    std::vector<Copy> copies_;
    std::vector<int> first_region_{0}, component_of_, region_of_;
    std::vector<Transfer> transfers_;
    std::vector<Range> clusters_of_region_;
};

} // namespace toile
