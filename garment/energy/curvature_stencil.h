#pragma once

#include <vector>

#include "garment/energy/rest_shape.h"

namespace toile {

/// Second derivatives of a function on one triangle as weights on the vertices around it.
struct CurvatureStencil {
    std::vector<int> vertex;                          ///< at most 12
    Eigen::Matrix<double, 3, Eigen::Dynamic> weights; ///< rows: f_uu, f_uv, f_vv in material axes [1/m^2]
};

/// Stencils of all triangles, from the slopes phi across the triangle's edges:
///
///   S_t = sum_k (l_k / A) phi_tk m_k m_k^T          (divergence theorem; m_k outward edge normals in the
///   plane)
///
/// phi_tk is the slope of the surface across edge k at its midpoint, relative to the plane of triangle t. Two
/// conditions make an operator converge on any triangulation: S_t exact for quadratics, and the slopes of
/// both sides adding up to the whole jump theta_k, so that sum_t A_t S_t telescopes. The edge-averaged
/// operator phi = theta / 2 [Grinspun et al. 2006] has only the second (10 to 20 % too stiff on irregular
/// meshes), the quadratic through the triangle's six vertices only the first (5 to 12 % too soft, at every
/// resolution). Both hold for the fit's slopes, symmetrised across each edge:
///
///   phi_tk = ( theta_k + fit_t(k) - fit_s(k) ) / 2,   s the triangle across edge k
///
/// which is within 1 % on the same meshes and converges (docs/garment/bending.md). At the border phi is the
/// fit's own slope: the moment-free edge.
std::vector<CurvatureStencil> curvature_stencils(const RestShape& rest);

} // namespace toile
