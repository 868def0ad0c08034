#pragma once

#include <memory>
#include <vector>

#include "garment/energy/bending.h"
#include "garment/energy/membrane.h"

namespace toile::garment {

/// Cloth as parameters of its energies, for methods with their own evaluation of them.
struct ClothModel {
    std::shared_ptr<const RestShape> rest;
    std::vector<double> masses; ///< [vertices] [kg], positive
    Membrane::Settings stretch;
    Bending::Settings bending;
};

} // namespace toile::garment
