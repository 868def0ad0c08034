#pragma once

#include <memory>
#include <vector>

#include "garment/energy/rest_shape.h"
#include "garment/fabric/fabric.h"
#include "scenes/surfaces/cloth_state.h"

namespace toile::garment {
class Membrane;
} // namespace toile::garment

namespace toile::scenes {

/// Triangles of a cloth that are of one fabric, with their membrane.
struct FabricPart {
    garment::Fabric fabric;
    std::shared_ptr<const garment::RestShape> rest; ///< of these triangles, with all vertices of the cloth
    std::vector<double> stiffness;                  ///< [triangles] of these, see ClothState
    std::shared_ptr<garment::Membrane> membrane;    ///< null for a baseline method
};

/// Parts of a cloth by fabric, without membranes. A cloth of one fabric is one part.
/// @param rest  of the whole cloth
std::vector<FabricPart> fabric_parts(const ClothState& cloth,
                                     const std::shared_ptr<const garment::RestShape>& rest);

/// Masses of the vertices [kg].
std::vector<double> masses_of(const std::vector<FabricPart>& parts);

} // namespace toile::scenes
