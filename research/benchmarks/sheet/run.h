#pragma once

#include <functional>

#include "research/benchmarks/sheet/settings.h"

namespace toile::research::sheet {

/// Results of one setting on one sheet. Times are wall clock, of steps from kWarmUp on.
struct Result {
    Setting setting;
    double first_ms = 0.0; ///< first step, which analyses and factors H
    double mean_ms = 0.0;
    double median_ms = 0.0;
    double user_ms = 0.0; ///< processor time of all threads, mean
    double iterations_per_step = 0.0;
    double max_strain = 0.0; ///< [-] at the end
    /// RMS distance of vertices from the reference, in edge lengths, at Sheet::compared.
    std::vector<double> errors;
    std::vector<std::vector<Vec3>> samples; ///< positions at Sheet::compared [m]
};

/// Steps excluded from means: the first one factors H, the next ones fill caches.
inline constexpr int kWarmUp = 3;

/// Runs one setting from the start.
/// @param after_step  called with the number of steps done; false stops the run
Result run(const Sheet& sheet, const Setting& setting, const std::function<bool(int)>& after_step);

/// Faster of two runs of one setting, whose positions are equal.
Result faster(Result a, Result b);

/// Computes the errors of all results with a reference among them.
void compare(const Sheet& sheet, std::vector<Result>& results);

} // namespace toile::research::sheet
