#pragma once

#include <string>

#include "core/mesh/triangle_mesh.h"

namespace toile {

/// Integrals over the inside of a closed surface.
struct SolidMoments {
    double volume = 0.0;        ///< [m^3]
    Vec3 centre = Vec3::Zero(); ///< of volume [m]
    Mat3 second = Mat3::Zero(); ///< integral of (X - centre) (X - centre)^T [m^5]
};

/// Moments of the solid inside a closed surface, exact up to rounding: sums the signed tetrahedra from a
/// point to every triangle (the divergence theorem) [Mirtich 1996, Fast and accurate computation of
/// polyhedral mass properties].
/// @param surface  [vertices], [triangles] counter-clockwise seen from outside; several closed parts may be
///                 one solid. Vertices that no triangle uses are ignored.
/// @param source   named in errors
/// @throws InvalidInput for a surface that is not closed (naming an edge), is inside out or has no volume
SolidMoments solid_moments(const TriangleMesh& surface, const std::string& source);

} // namespace toile
