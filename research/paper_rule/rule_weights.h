#pragma once

#include <vector>

#include "research/paper_rule/far_clusters.h"
#include "research/paper_rule/field_domains.h"
#include "research/paper_rule/gaussian_fit.h"
#include "research/paper_rule/rule_kernels.h"

namespace toile::research {

/// Settings of the paper's rule, with the paper's values.
struct RuleSettings {
    DomainSettings domains;
    int sample_count = 8;   ///< |S_i| of eq. 17, the vertex included
    double penalty = 100.0; ///< mu of eq. 17 [-]
    int order = 3;          ///< of Gauss-Legendre per axis, 3 or 4
    int cluster_count = 8;  ///< of the far field
    unsigned seed = 1;      ///< of k-means++; added to the vertex's index
};

/// The near field of one vertex, ready for fit and stacking.
struct NearField {
    FieldDomains domains;
    Box<2> near, middle;      ///< the domains [m]
    std::vector<int> samples; ///< [at most sample_count] S_i, the vertex first
    GaussianTarget<2> target; ///< S_i and F_i, and values of u at S_i
    Gaussian<2> gaussian;     ///< fitted to u
};

/// Domains, samples and the Gaussian that fits u.
///
/// The paper fits amplitude and widths to u b / |Omega| anew in every global step. We fit the widths to u
/// once, so that the rule is linear in b and can be tabulated; the amplitude follows b (amplitude_weights()).
/// The two fits were within a few per cent of each other.
/// @param u  [vertices] the kernel row u(i) [-], u_i = 1
NearField near_field(const UvSurface& surface, int vertex, View<const double> u,
                     const RuleSettings& settings);

/// Weights of the rule: u(i)^T b is taken for sum_k weight_k b_k over about 8 + 3 * 9 + 8 vertices.
///
///   phi_k = u_k b_k / |Omega_k| at vertices, barycentric in between, zero beside the surface     [eq. 9, 10]
///   near    A * integral of the Gaussian over the near box                                          [eq. 16]
///   middle  Gauss-Legendre of phi - G in near, phi outside                                      [eq. 18, 20]
///   far     sum over clusters of area * phi at the vertex closest to the centre                     [eq. 21]
///
/// @return distinct vertices, ascending
std::vector<WeightedVertex> rule_weights(const UvSurface& surface, int vertex, View<const double> u,
                                         const RuleSettings& settings);

} // namespace toile::research
