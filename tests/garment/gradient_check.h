#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/pd/energy/energy.h"

namespace toile::test {

inline double value_of(Energy& energy, const std::vector<Vec3>& x)
{
    std::vector<Vec3> ignored(x.size(), Vec3::Zero());
    return energy.add_gradient(x, ignored);
}

/// Compares the gradient at x [vertices] with central differences of the value.
inline void expect_gradient_of_value(Energy& energy, std::vector<Vec3> x)
{
    std::vector<Vec3> gradient(x.size(), Vec3::Zero());
    energy.add_gradient(x, gradient);
    const double step = 1e-6;
    for (size_t v = 0; v < x.size(); ++v)
        for (int k = 0; k < 3; ++k) {
            const double here = x[v][k];
            x[v][k] = here + step;
            const double up = value_of(energy, x);
            x[v][k] = here - step;
            const double down = value_of(energy, x);
            x[v][k] = here;
            EXPECT_NEAR(gradient[v][k], (up - down) / (2.0 * step), 1e-6 * (1.0 + std::abs(gradient[v][k])));
        }
}

} // namespace toile::test
