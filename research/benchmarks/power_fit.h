#pragma once

#include <vector>

namespace toile::research {

/// Fit y = factor x^exponent, by least squares of logarithms.
struct PowerFit {
    double exponent = 0.0;
    double factor = 0.0;
    double worst = 1.0; ///< maximum of y over the fit and the fit over y; 1: every point lies on it
    int points = 0;     ///< with positive x and y: others have no logarithm. Below 2: no fit
};

/// @param x, y  of equal length
/// @throws InvalidInput if they are not, or a number is not finite
PowerFit fit_power(const std::vector<double>& x, const std::vector<double>& y);

} // namespace toile::research
