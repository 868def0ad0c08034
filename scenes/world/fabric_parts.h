#pragma once

#include <memory>
#include <string>
#include <vector>

#include "garment/energy/membrane.h"
#include "garment/energy/strain_limit/strain_limit.h"
#include "garment/fabric/fabric.h"
#include "scenes/surfaces/cloth_state.h"

namespace toile::scenes {

/// Triangles of a cloth that are of one fabric, with the energies of their membrane.
struct FabricPart {
    garment::Fabric fabric;
    std::shared_ptr<const garment::RestShape> rest;   ///< of these triangles, with all vertices of the cloth
    std::shared_ptr<garment::Membrane> membrane;      ///< null for a baseline method
    std::shared_ptr<garment::StretchTension> tension; ///< null for a baseline method
    std::unique_ptr<garment::StrainLimit> strain_limit;
};

/// Parts of a cloth by fabric, without membranes and tensions. A cloth of one fabric is one part.
/// @param rest    of the whole cloth
/// @param source  for errors
/// @throws InvalidInput as StrainLimit
std::vector<FabricPart> fabric_parts(const ClothState& cloth,
                                     const std::shared_ptr<const garment::RestShape>& rest,
                                     const std::string& source);

/// Masses of the vertices [kg].
std::vector<double> masses_of(const std::vector<FabricPart>& parts);

} // namespace toile::scenes
