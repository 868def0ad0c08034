#pragma once

#include "garment/energy/cuda/triangle_sides.h"
#include "garment/energy/viscosity_kernels.h"

namespace toile::garment {

/// membrane_curvature() for one triangle, projected, as a GPU runs it; the CPU runs eight at a time
/// (membrane_lanes.h).
/// @tparam Viscosity  NoViscosity or ViscousTriangles
template <typename Viscosity>
struct CurveMembraneTriangle {
    View<const Vec3> x;        ///< [vertices] positions [m]
    View<const Triangle> tri;  ///< [triangles] vertex indices
    View<const Mat2> rest_inv; ///< [triangles] inverse rest edge matrices [1/m]
    View<const double> area;   ///< [triangles] rest areas [m^2]
    View<const int> fabric;    ///< [triangles] into weights
    View<const MembraneWeights> weights;
    Viscosity viscosity;
    HessianBlocks sides; ///< out: see set_sides()

    TOILE_HD void operator()(int t) const
    {
        const Mat32 F = deformation_gradient(x, tri[t], rest_inv[t]);
        MembraneCurvature<double> H = membrane_curvature<double>(F, weights[fabric[t]], true);
        viscosity.add_curvature(t, F, H);
        set_sides(H, rest_inv[t], area[t], t, sides);
    }
};

} // namespace toile::garment
