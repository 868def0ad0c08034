#pragma once

#include <optional>
#include <vector>

namespace toile {

/// A time among samples: linear interpolation takes (1 - part) of `sample` and `part` of the next one.
struct SamplePlace {
    int sample = 0;
    double part = 0.0; ///< [0, 1); 0 for the last sample
};

/// Where time t lies: held before the first sample and after the last. A time within 1e-9 of an interval from
/// a sample is that of the sample, for times of frames are quotients with rounding errors.
/// @param times  strictly increasing, at least one
SamplePlace place_in(const std::vector<double>& times, double t);

/// The first sample whose time is not greater than that of the one before.
std::optional<int> first_not_increasing(const std::vector<double>& times);

} // namespace toile
