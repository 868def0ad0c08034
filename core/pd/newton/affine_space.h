#pragma once

#include <array>
#include <utility>
#include <vector>

#include "core/compute/lanes.h"
#include "core/pd/energy/objective.h"
#include "core/pd/newton/block_cholesky.h"
#include "core/quadrature/clusters/cluster_tree.h"

namespace toile {

/// Coarse space of fields that are affine on clusters of 64 vertices: u = a + b X + c Y with nine unknowns
/// per cluster, the Galerkin matrix K_c = p^T K p, and its sparse factor. It represents what a smoother of K
/// cannot reach: motion and stretch of whole regions.
///
/// Clusters and functions are those of the quadrature (ClusterTree, ClusterBasis), on the vertices that are
/// free. A cluster lies in one connected component of K. Components of fewer vertices than a leaf have none.
class AffineSpace {
public:
    /// Functions of a cluster, each for x, y and z.
    static constexpr int kFunctions = 3;

    /// @param points  [vertices] undeformed positions
    explicit AffineSpace(std::vector<EmbeddedPoint> points) : points_(std::move(points)) {}

    /// Finds the clusters of the free vertices.
    void find_clusters(const HessianParts& K);

    int cluster_count() const { return int(first_of_cluster_.size()) - 1; }

    /// Free vertices in the order of rows: cluster after cluster, then those without a cluster.
    const std::vector<int>& order() const { return order_; }

    /// Rows of a cluster: [first_row(c), first_row(c + 1)).
    int first_row(int cluster) const { return first_of_cluster_[cluster]; }

    /// Assembles and factors K_c.
    /// @return false if K_c is not positive definite: solve() is then not allowed
    bool update(const HessianParts& K);

    /// Restricts a field on the rows to the right-hand side of a cluster.
    void restrict_to(int cluster, View<const PaddedVec3> r);

    void solve();

    /// Correction of a row in a cluster.
    PaddedVec3 prolonged(int cluster, int row) const;

private:
    using Functions = Eigen::Vector3d;
    using Block = BlockCholesky::Block;
    /// Contact term on the coarse unknowns: for each cluster that it touches, sum_k weight_k p_k.
    struct CoarseTerm {
        std::array<int, 4> cluster{-1, -1, -1, -1};
        std::array<Functions, 4> weight;
        Mat3 stiffness;
    };

    void add_component(std::vector<int> vertices);
    void find_terms(const std::vector<FrozenTerm>& terms);
    void find_couplings(const HessianParts& K);
    bool add_couplings_of_terms();
    void assemble(const HessianParts& K, int cluster);

    std::vector<EmbeddedPoint> points_;
    std::vector<int> order_;            ///< [rows]
    std::vector<int> first_of_cluster_; ///< [clusters + 1] rows
    std::vector<int> cluster_of_;       ///< [vertices] -1: none
    std::vector<Functions> functions_;  ///< [vertices] values of the functions of its cluster
    std::vector<PaddedVec3> functions_of_row_;
    std::vector<CoarseTerm> terms_;
    std::vector<std::vector<int>> terms_of_;  ///< [clusters] 4 * term + slot
    std::vector<std::vector<int>> couplings_; ///< [clusters] coupled clusters, ascending, itself included
    bool has_new_couplings_ = true;
    BlockCholesky factor_;
    std::vector<BlockCholesky::Vector> coarse_; ///< [clusters] right-hand side, then solution
    std::vector<std::array<PaddedVec3, kFunctions>> correction_; ///< [clusters] solution by function
};

} // namespace toile
