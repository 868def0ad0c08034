#pragma once

#include <string>
#include <vector>

#include "core/mesh/obj.h"
#include "core/mesh/triangle_mesh.h"
#include "garment/fabric/fabric.h"
#include "garment/pattern/pattern.h"
#include "scenes/drape/garment_mesh.h"
#include "scenes/surfaces/load_cloth.h"

namespace toile::app {

/// A garment on a body.
struct FittedGarment {
    std::string name;
    TriangleMesh mesh;              ///< [m]
    std::vector<FlatTriangle> rest; ///< [triangles] corners in the flat panels [m]
    std::vector<garment::Fabric> fabrics;
    std::vector<int> fabric_of_triangle; ///< [triangles] into fabrics
    std::vector<double> stiffness;       ///< [triangles] painted factor on that of the fabric [-]; empty: 1
};

/// @param surface  with a texture; the panels of its groups are those of the pattern
/// @param fabric   preset of panels without one
FittedGarment fitted_garment(const std::string& name, const scenes::GarmentSurface& surface,
                             const garment::Pattern& pattern, const std::string& fabric);

/// A cloth of a scene.
/// @param x  [vertices] [m]
FittedGarment fitted_garment(const scenes::LoadedCloth& cloth, std::vector<Vec3> x);

/// A cloth of a scene without its attachments, which don't change how it fits.
scenes::LoadedCloth unattached_cloth(const scenes::Scene& scene, size_t cloth);

} // namespace toile::app
