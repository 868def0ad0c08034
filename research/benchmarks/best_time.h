#pragma once

#include <algorithm>
#include <chrono>
#include <limits>

namespace toile::research {

/// Minimum time of work() [ms] over repetitions that last `seconds`, at least one.
template <typename Work>
double best_ms(double seconds, const Work& work)
{
    using Clock = std::chrono::steady_clock;
    const auto ms_since = [](Clock::time_point start) {
        return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    };
    const Clock::time_point begin = Clock::now();
    double best = std::numeric_limits<double>::max();
    do {
        const Clock::time_point start = Clock::now();
        work();
        best = std::min(best, ms_since(start));
    } while (ms_since(begin) < 1e3 * seconds);
    return best;
}

} // namespace toile::research
