#pragma once

#include <vector>

#include "core/compute/lanes.h"
#include "core/linear/block_matrix.h"
#include "core/linear/sparse_matrix.h"
#include "core/quadrature/clusters/cluster_tree.h"

namespace toile {

/// Nested clusters of 64, 1024, 16384 and so on vertices, and on each of them three functions, close to 1 and
/// two coordinates: the coarse spaces of an additive preconditioner. Functions and clusters are those of
/// ClusterTree and ClusterBasis. A cluster lies in one connected component of a matrix.
///
/// The clusters of a level form blocks, up to 16 children of one parent each, whose coupling a solver inverts
/// exactly. Levels end where a component has one block. The rest of the last blocks is shared with other
/// components.
class ClusterHierarchy {
public:
    static constexpr int kChildren = 16;    ///< of a cluster, and clusters of a block
    static constexpr int kClusterSize = 64; ///< vertices of a cluster of level 0
    static constexpr int kMaxLevels = 5;
    static constexpr int kFunctions = 3;

    /// Functions of a cluster of level 0 as combinations of those of its ancestor: column by column.
    struct Transfer {
        float entry[kFunctions][kFunctions] = {};
    };

    struct Level {
        int cluster_count = 0;
        std::vector<int> cluster_of;                       ///< [clusters of level 0] the ancestor; -1: none
        std::vector<Transfer> transfer;                    ///< [clusters of level 0]
        std::vector<int> first_of_cluster, end_of_cluster; ///< [clusters] its descendants of level 0
        std::vector<int> block_of, slot_of; ///< [clusters] its block of this level, and its place there
        std::vector<int> first_of_block;    ///< [blocks + 1] clusters
        int block_count() const { return int(first_of_block.size()) - 1; }
    };

    /// @param points     [vertices] undeformed positions
    /// @param blocks, isotropic  patterns that connect vertices
    ClusterHierarchy(View<const EmbeddedPoint> points, const BlockMatrix& blocks,
                     const SparseMatrix& isotropic);

    /// Vertices of clusters of level 0; the last ones may hold vertices of small components, whose functions
    /// are zero.
    const std::vector<int>& first_vertex() const { return first_vertex_; } ///< [clusters + 1] into vertices()
    const std::vector<int>& vertices() const { return vertices_; }
    int cluster_count() const { return int(first_vertex_.size()) - 1; }     ///< of level 0, these included
    const std::vector<int>& cluster_of() const { return cluster_of_; }      ///< [vertices]
    const std::vector<PaddedVec3>& functions() const { return functions_; } ///< [vertices] of level 0
    const std::vector<Level>& levels() const { return levels_; }

private:
    void add_component(View<const EmbeddedPoint> points, std::vector<int> vertices);
    void add_others(const std::vector<int>& vertices);
    void find_blocks(int level);

    std::vector<int> first_vertex_{0}, vertices_, cluster_of_;
    std::vector<PaddedVec3> functions_;
    std::vector<Level> levels_;
};

} // namespace toile
