#pragma once

#include <deque>
#include <vector>

#include "core/compute/types.h"

namespace toile::scenes {

/// Tells whether cloth is at rest: for half a second no vertex was faster than kMaxSpeed, and none has moved
/// further than kMaxMotion.
class RestWatch {
public:
    static constexpr double kDuration = 0.5;    ///< [s]
    static constexpr double kMaxSpeed = 0.02;   ///< [m/s]
    static constexpr double kMaxMotion = 0.002; ///< [m]

    /// @param frame  [s] between samples
    explicit RestWatch(double frame) : frame_(frame) {}

    void add(View<const Vec3> x);

    bool is_at_rest() const;
    double speed() const { return speed_; } ///< [m/s] of the fastest vertex in the last half second

private:
    double frame_;
    std::deque<std::vector<Vec3>> samples_;
    double speed_ = 0.0;
    double motion_ = 0.0;
};

} // namespace toile::scenes
