#pragma once

#include <cmath>
#include <limits>

#include "core/compute/parallel.h"
#include "core/pd/energy/objective.h"

namespace toile {

/// No motion as the start of a step: the positions of t0, with fixed vertices at their targets.
struct RestStart {
    View<const Vec3> x, prediction;  ///< [vertices] [m]
    View<const double> inertia;      ///< [vertices] [N/m]
    View<const unsigned char> fixed; ///< [vertices]

    /// Value of the objective there [J]; infinite, without evaluation, if its inertia alone is `limit` or
    /// more.
    /// @param standing, gradient  [vertices] out; gradient only if evaluated
    double value(Objective& objective, double limit, View<Vec3> standing, View<Vec3> gradient) const
    {
        for (int i = 0; i < x.size(); ++i)
            standing[i] = fixed[i] ? prediction[i] : x[i];
        const double of_inertia = 0.5 * parallel_sum(kCpu, x.size(), 0.0, [&](int i) {
                                      return inertia[i] * (standing[i] - prediction[i]).squaredNorm();
                                  });
        if (limit <= of_inertia)
            return std::numeric_limits<double>::infinity();
        const double value = objective.evaluate(standing, gradient);
        return std::isfinite(value) ? value : std::numeric_limits<double>::infinity();
    }
};

} // namespace toile
