#pragma once

#include <string>
#include <vector>

namespace toile::garment {

/// A cloth material in physical units.
struct Fabric {
    std::string name;
    double areal_density = 0.15; ///< [kg/m^2]
    double thickness = 0.3e-3;   ///< [m] determines the gap to bodies and other cloth
    double stretch_warp = 250.0; ///< [N/m] Young's modulus x thickness along the warp
    double stretch_weft = 250.0; ///< [N/m] along the weft
    double shear = 100.0;        ///< [N/m] at most half of the smaller stretch modulus
    double bend_warp = 5e-6;     ///< [N m] rigidity when the warp bends
    double bend_weft = 5e-6;     ///< [N m]
    double strain_limit = 0.06;  ///< [-] maximum principal stretch minus one
    double damping = 0.0;        ///< [1/s] decay rate of velocities, on top of the air's

    // Internal friction (docs/theory/damping.md).
    double stretch_damping = 0.001; ///< [s] viscosity over stiffness along the yarns
    double shear_damping = 0.003;   ///< [s] of shear
    double bend_damping = 0.03;     ///< [s] of bending
    double bend_friction = 12.0;    ///< [1/m] curvature that friction between yarns holds

    /// @throws InvalidInput naming `source`, the property, its value and its range.
    void validate(const std::string& source) const;
};

/// Built-in fabrics, sorted by name.
///
/// cotton, wool, wool_lycra and polyester are the isotropic constants of measured cloth [Penava et al. 2014,
/// as tabulated by C-IPC, Li et al. 2021]. The others are chosen by areal density and linear rigidity inside
/// the 5 % to 95 % range of a survey of 618 fabrics (0.03-0.49 kg/m^2, 1-70 uN m).
const std::vector<Fabric>& fabric_presets();

/// @throws InvalidInput naming `source` and the nearest preset if there is none of that name.
const Fabric& fabric_preset(const std::string& name, const std::string& source);

} // namespace toile::garment
