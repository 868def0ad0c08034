#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/linear/cholesky.h"
#include "core/pd/energy/objective.h"
#include "core/quadrature/clusters/cluster_tree.h"

namespace toile {

/// Coarse space of fields that are affine on clusters of 64 vertices: u = a + b X + c Y with nine unknowns per
/// cluster, the Galerkin matrix K_c = p^T K p, and its sparse factor. It represents what a smoother of K
/// cannot reach: motion and stretch of whole regions.
///
/// Clusters and functions are those of the quadrature (ClusterTree, ClusterBasis), on the vertices that are
/// free. A cluster lies in one connected component of K. Components of fewer vertices than a leaf have none.
class AffineSpace {
public:
    /// Unknowns of a cluster: three functions for each of x, y and z.
    static constexpr int kFunctions = 3, kUnknowns = 3 * kFunctions;

    /// @param points  [n] of undeformed positions
    explicit AffineSpace(std::vector<EmbeddedPoint> points) : points_(std::move(points)) {}

    /// Assembles and factors K_c. Finds the clusters anew if other vertices are fixed than before.
    /// @return false if K_c is not positive definite: correct() then does nothing
    bool update(const HessianParts& K);

    /// z += p K_c^-1 p^T r
    /// @param r, z  [n]
    void correct(View<const Vec3> r, View<Vec3> z);

    int cluster_count() const { return int(first_of_cluster_.size()) - 1; }

private:
    using Functions = Eigen::Vector3d;
    using Block = Eigen::Matrix<double, kUnknowns, kUnknowns>;
    /// Contact term on the coarse unknowns: for each cluster that it touches, sum_k weight_k p_k.
    struct CoarseTerm {
        std::array<int, 4> cluster{-1, -1, -1, -1};
        std::array<Functions, 4> weight;
        Mat3 stiffness;
    };

    void find_clusters(const HessianParts& K);
    void add_component(std::vector<int> vertices);
    void find_terms(const std::vector<FrozenTerm>& terms);
    void find_couplings(const HessianParts& K);
    bool add_couplings_of_terms();
    void build_pattern();
    void assemble(const HessianParts& K, int cluster);

    std::vector<EmbeddedPoint> points_;
    std::vector<unsigned char> fixed_;   ///< [n] for which the clusters were found
    std::vector<int> cluster_of_;        ///< [n] -1: none
    std::vector<Functions> functions_;   ///< [n] values p_i of the functions of its cluster
    std::vector<int> first_of_cluster_;  ///< [clusters + 1] into vertices_
    std::vector<int> vertices_;          ///< cluster after cluster
    std::vector<CoarseTerm> terms_;
    std::vector<std::vector<int>> terms_of_;  ///< [clusters] 4 * term + slot
    std::vector<std::vector<int>> couplings_; ///< [clusters] coupled clusters, ascending, itself included
    SparseMatrix matrix_;                     ///< K_c [9 clusters x 9 clusters]
    std::optional<Cholesky> factor_;
    bool is_factored_ = false;
    std::vector<Vec3> coarse_; ///< [9 clusters] right-hand side and solution in their first entries
};

} // namespace toile
