#pragma once

#include "garment/energy/cuda/triangle_sides.h"
#include "garment/energy/strain_limit/stretch_tension_kernels.h"

namespace toile::garment {

/// Second derivative of the triangles beyond their limit, as a GPU evaluates it.
struct CurveTensionTriangle {
    TensionPull pull;
    View<const unsigned char> near; ///< [triangles]
    View<unsigned char> exceeds;    ///< [triangles] out
    HessianBlocks sides;            ///< out where it exceeds: see set_sides()

    TOILE_HD void operator()(int t) const
    {
        const bool is_beyond = near[t] && pull.exceeds(t);
        exceeds[t] = is_beyond ? 1 : 0;
        if (is_beyond)
            set_sides(pull.curvature(t), pull.triangles.rest_inv[t], pull.weight(t), t, sides);
    }
};

} // namespace toile::garment
