#pragma once

#include <memory>
#include <vector>

#include "garment/energy/bending.h"
#include "garment/energy/membrane_settings.h"
#include "garment/energy/rest_shape.h"

namespace toile::garment {

/// Cloth as parameters of its energies, for methods with their own evaluation of them.
struct ClothModel {
    std::shared_ptr<const RestShape> rest;
    std::vector<double> masses; ///< [vertices] [kg], positive
    MembraneSettings stretch;
    Bending::Settings bending;
};

} // namespace toile::garment
