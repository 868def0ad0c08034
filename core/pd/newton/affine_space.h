#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/compute/lanes.h"
#include "core/pd/energy/objective.h"
#include "core/quadrature/clusters/cluster_tree.h"

namespace toile {

/// Coarse space of fields that are affine on clusters of 64 vertices: u = a + b X + c Y on a surface, and
/// + d Z in a volume, with three unknowns a function and cluster, the Galerkin matrix K_c = p^T K p, and its
/// sparse factor. It represents what a smoother of K cannot reach: motion and stretch of whole regions.
///
/// Clusters are ConnectedClusters of the vertices that are free.
class AffineSpace {
public:
    /// @param points  [vertices] undeformed positions
    static std::unique_ptr<AffineSpace> make(std::vector<EmbeddedPoint> points, Extent extent);
    virtual ~AffineSpace() = default;

    /// Finds the clusters of the free vertices.
    virtual void find_clusters(const HessianParts& K) = 0;

    int cluster_count() const { return int(first_of_cluster_.size()) - 1; }

    /// Free vertices in the order of rows: cluster after cluster, then those without a cluster.
    const std::vector<int>& order() const { return order_; }

    /// Rows of a cluster: [first_row(c), first_row(c + 1)).
    int first_row(int cluster) const { return first_of_cluster_[cluster]; }

    /// Assembles and factors K_c.
    /// @return false if K_c is not positive definite: solve() is then not allowed
    virtual bool update(const HessianParts& K) = 0;

    /// Restricts a field on the rows to the right-hand side of a cluster.
    virtual void restrict_to(int cluster, View<const PaddedVec3> r) = 0;

    virtual void solve() = 0;

    /// Writes the correction of a cluster's rows. [rows]
    virtual void prolong(int cluster, View<PaddedVec3> z) const = 0;

protected:
    explicit AffineSpace(std::vector<EmbeddedPoint> points) : points_(std::move(points)) {}

    std::vector<EmbeddedPoint> points_;
    std::vector<int> order_;            ///< [rows]
    std::vector<int> first_of_cluster_; ///< [clusters + 1] rows
};

} // namespace toile
