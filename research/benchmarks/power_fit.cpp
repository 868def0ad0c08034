#include "research/benchmarks/power_fit.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/error.h"

namespace toile::research {

PowerFit fit_power(const std::vector<double>& x, const std::vector<double>& y)
{
    if (x.size() != y.size())
        throw InvalidInput("fit_power: " + std::to_string(x.size()) + " x and " + std::to_string(y.size()) +
                           " y; give a y to every x");
    PowerFit fit;
    std::vector<double> log_x, log_y;
    for (size_t i = 0; i < x.size(); ++i) {
        if (!std::isfinite(x[i]) || !std::isfinite(y[i]))
            throw InvalidInput("fit_power: point " + std::to_string(i) + " is not finite");
        if (x[i] > 0.0 && y[i] > 0.0) {
            log_x.push_back(std::log(x[i]));
            log_y.push_back(std::log(y[i]));
        }
    }
    const int n = int(log_x.size());
    double mean_x = 0.0, mean_y = 0.0, xx = 0.0, xy = 0.0;
    for (int i = 0; i < n; ++i) {
        mean_x += log_x[i] / n;
        mean_y += log_y[i] / n;
    }
    for (int i = 0; i < n; ++i) {
        xx += (log_x[i] - mean_x) * (log_x[i] - mean_x);
        xy += (log_x[i] - mean_x) * (log_y[i] - mean_y);
    }
    if (!(xx > 0.0)) // one size only
        return fit;
    fit.points = n;
    fit.exponent = xy / xx;
    fit.factor = std::exp(mean_y - fit.exponent * mean_x);
    for (int i = 0; i < n; ++i)
        fit.worst =
            std::max(fit.worst, std::exp(std::abs(log_y[i] - mean_y - fit.exponent * (log_x[i] - mean_x))));
    return fit;
}

} // namespace toile::research
