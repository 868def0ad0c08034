#include "core/time/sample_times.h"

#include <algorithm>

namespace toile {

namespace {

/// Distance from a sample at which a time is taken to be the sample's [intervals].
constexpr double kSnap = 1e-9;

} // namespace

SamplePlace place_in(const std::vector<double>& times, double t)
{
    const auto after = std::upper_bound(times.begin(), times.end(), t);
    if (after == times.begin())
        return {0, 0.0};
    const int sample = int(after - times.begin()) - 1;
    if (after == times.end())
        return {sample, 0.0};
    const double part = (t - *(after - 1)) / (*after - *(after - 1));
    if (part > 1.0 - kSnap)
        return {sample + 1, 0.0};
    return {sample, part < kSnap ? 0.0 : part};
}

std::optional<int> first_not_increasing(const std::vector<double>& times)
{
    const auto at =
        std::adjacent_find(times.begin(), times.end(), [](double a, double b) { return !(a < b); });
    return at == times.end() ? std::nullopt : std::optional(int(at - times.begin()) + 1);
}

} // namespace toile
