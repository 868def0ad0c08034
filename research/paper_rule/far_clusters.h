#pragma once

#include <vector>

#include "research/paper_rule/field_domains.h"

namespace toile::research {

/// Part of the far field, and the vertex that represents it.
struct FarCluster {
    int vertex = 0;      ///< closest to the cluster's weighted mean
    double volume = 0.0; ///< |C| of eq. 21: lumped areas or volumes of the cluster's vertices [m^Dim]
};

/// Clusters of the vertices outside of `middle`, by k-means++ with weights |u| in each connected component of
/// the voxels outside [multilevel quadrature for PD, sec. 5.3, eq. 21]. The first centre is the vertex with
/// the largest weight. The next are drawn with probability weight times squared distance to the centres so
/// far. Lloyd iterations follow.
///
/// Components get clusters in proportion to their volumes, at least one each, so that there may be more than
/// `count` in all. Distances are straight; the paper takes geodesic ones.
/// @param u      [vertices] the kernel row u(i) [-]; components where it vanishes get no cluster
/// @param count  of clusters in all
/// @param seed   of the draws; the same seed gives the same clusters on every platform
template <int Dim>
std::vector<FarCluster> far_clusters(const VoxelisedMesh<Dim>& mesh, const VoxelBox<Dim>& middle,
                                     View<const double> u, int count, unsigned seed);

} // namespace toile::research
