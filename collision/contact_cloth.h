#pragma once

#include <vector>

namespace toile {

/// One of the cloths that a Contact looks after: how it keeps its distance, and what it is like to rub on.
struct ContactCloth {
    int vertex_count = 0;
    double gap = 0.002;                   ///< [m] between the cloth's middle surface and a collider
    double thickness = 0.5e-3;            ///< [m] half of it is kept to the middle surface of other cloth
    std::vector<double> partner_friction; ///< [partners] Coulomb coefficients [-]
    std::vector<double> cloth_friction;   ///< [cloths] with each of the cloths, itself included [-]
};

} // namespace toile
