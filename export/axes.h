#pragma once

#include <string>
#include <vector>

#include "core/compute/types.h"

namespace toile::exports {

/// Unit and upward axis of the numbers in a cache. The simulation's are metres with Y up.
struct Axes {
    std::string unit = "m"; ///< "m" or "cm"
    std::string up = "y";   ///< "y" or "z"

    double metres_per_unit() const { return unit == "cm" ? 0.01 : 1.0; }
    bool has_z_up() const { return up == "z"; }

    bool operator==(const Axes&) const = default;
};

/// Changes the numbers from one to the other. Equal ones leave every bit.
void change_axes(const Axes& from, const Axes& to, std::vector<Vec3>& positions);

} // namespace toile::exports
