#pragma once

#include <vector>

#include "garment/energy/rest_shape.h"

namespace toile::garment {

/// Second derivatives of a function on one triangle as weights on the vertices around it.
struct CurvatureStencil {
    std::vector<int> vertex;                          ///< at most 12
    Eigen::Matrix<double, 3, Eigen::Dynamic> weights; ///< rows: f_uu, f_uv, f_vv in material axes [1/m^2]
};

/// Stencils of all triangles, from the slopes phi across the triangle's edges:
///
///   S_t = sum_k (l_k / A) phi_tk m_k m_k^T     (divergence theorem; m_k in-plane outward edge normals)
///
/// phi_tk is the slope of the surface across edge k at its midpoint, relative to the plane of triangle t. Two
/// conditions make an operator converge on any triangulation. S_t must be exact for quadratics. The slopes
/// of both sides must add up to the whole jump theta_k, so that sum_t A_t S_t telescopes. The edge-averaged
/// operator phi = theta / 2 [Grinspun et al. 2006] meets only the second (10 to 20 % too stiff on irregular
/// meshes). The quadratic through the triangle's six vertices meets only the first (5 to 12 % too soft, at
/// every resolution). The slopes of that fit, symmetrised across each edge, meet both:
///
///   phi_tk = ( theta_k + fit_t(k) - fit_s(k) ) / 2,   s the triangle across edge k
///
/// The result is within 1 % on the same meshes and converges (docs/journal/bending.md). At the border phi is
/// the fit's own slope, and the fit has no curvature across the border: the moment-free edge.
/// @param hinges  inner edges, as indices into Topology::edges, that are borders to the stencils of both
/// sides
std::vector<CurvatureStencil> curvature_stencils(const RestShape& rest, const std::vector<int>& hinges = {});

} // namespace toile::garment
