#pragma once

#include <vector>

#include "research/paper_rule/far_clusters.h"
#include "research/paper_rule/field_domains.h"
#include "research/paper_rule/gaussian_fit.h"
#include "research/paper_rule/rule_kernels.h"

namespace toile::research {

/// Rule for near and middle field: the paper's, and the alternatives of its ablations (sec. 7.2).
enum class NearMiddle {
    Stacked, ///< the Gaussian over the near box; Gauss-Legendre on the middle box for what it leaves
    /// Figure 7: Gauss-Legendre with four points per axis on the near box, and the middle box's points
    /// outside of it.
    GaussLegendre,
    /// Figure 8: the Gaussian over the near box; Gauss-Legendre with two points per axis on each of the boxes
    /// around it.
    Subdivided,
};

/// Settings of the paper's rule, with the paper's values.
struct RuleSettings {
    DomainSettings domains;
    NearMiddle near_middle = NearMiddle::Stacked;
    int sample_count = 8;   ///< |S_i| of eq. 17, the vertex included
    double penalty = 100.0; ///< mu of eq. 17 [-]
    int order = 3;          ///< of Gauss-Legendre per axis in the middle box, 3 or 4
    int cluster_count = 8;  ///< of the far field
    unsigned seed = 1;      ///< of k-means++; added to the vertex's index
};

/// The near field of one vertex, ready for fit and stacking.
template <int Dim>
struct NearField {
    FieldDomains<Dim> domains;
    Box<Dim> near, middle;      ///< the domains [m]
    std::vector<int> samples;   ///< [at most sample_count] S_i, the vertex first
    GaussianTarget<Dim> target; ///< S_i and F_i, and values of u at S_i
    Gaussian<Dim> gaussian;     ///< fitted to u
};

/// Domains, samples and the Gaussian that fits u.
///
/// The paper fits amplitude and widths to u b / |Omega| anew in every global step. We fit the widths to u
/// once, so that the rule is linear in b and can be tabulated; the amplitude follows b (amplitude_weights()).
/// The two fits were within a few per cent of each other.
/// @param u  [vertices] the kernel row u(i) [-], u_i = 1
template <int Dim>
NearField<Dim> near_field(const VoxelisedMesh<Dim>& mesh, int vertex, View<const double> u,
                          const RuleSettings& settings);

/// Weights of the rule: u(i)^T b is taken for sum_k weight_k b_k. With the default settings, which stack near
/// and middle field, these are about 8 + 3 * 9 + 8 = 43 vertices of a surface, 8 + 4 * 27 + 8 = 124 of a
/// solid; the other placements of NearMiddle have other numbers.
///
///   phi_k = u_k b_k / |Omega_k| at vertices, barycentric in between, zero beside the mesh       [eq. 9, 10]
///   near    A * integral of the Gaussian over the near box                                          [eq. 16]
///   middle  Gauss-Legendre of phi - G in near, phi outside                                      [eq. 18, 20]
///   far     sum over clusters of volume * phi at the vertex closest to the centre                   [eq. 21]
///
/// @return distinct vertices, ascending
template <int Dim>
std::vector<WeightedVertex> rule_weights(const VoxelisedMesh<Dim>& mesh, int vertex, View<const double> u,
                                         const RuleSettings& settings);

} // namespace toile::research
