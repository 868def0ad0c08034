#pragma once

#include <string>
#include <vector>

#include "core/mesh/obj.h"
#include "core/mesh/triangle_mesh.h"
#include "garment/fabric/fabric.h"
#include "garment/pattern/pattern.h"
#include "scenes/drape/garment_mesh.h"

namespace toile::app {

/// A garment on a body.
struct FittedGarment {
    std::string name;
    TriangleMesh mesh;              ///< [m]
    std::vector<FlatTriangle> rest; ///< [triangles] corners in the flat panels [m]
    std::vector<garment::Fabric> fabrics;
    std::vector<int> fabric_of_triangle; ///< [triangles] into fabrics
};

/// @param surface  with a texture; the panels of its groups are those of the pattern
/// @param fabric   preset of panels without one
FittedGarment fitted_garment(const std::string& name, const scenes::GarmentSurface& surface,
                             const garment::Pattern& pattern, const std::string& fabric);

} // namespace toile::app
