#pragma once

namespace toile::garment {

/// Stiffness and damping of a Membrane, of one fabric.
struct MembraneSettings {
    double warp = 250.0; ///< [N/m] k_u, Young's modulus x thickness along the warp. Must be positive.
    double weft = 250.0; ///< [N/m] k_v along the weft. Must be positive.
    double shear = 50.0; ///< [N/m] G. Positive and at most half of the smaller of warp and weft.
    double stretch_damping = 0.0; ///< [s] of warp and weft: viscosity over stiffness. Not negative.
    double shear_damping = 0.0;   ///< [s]
};

} // namespace toile::garment
