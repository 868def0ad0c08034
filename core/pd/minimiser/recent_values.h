#pragma once

#include "core/compute/types.h"

namespace toile {

/// Objective at the last points of a descent; detects when further iterations gain too little.
class RecentValues {
public:
    /// Iterations considered together: a single one of L-BFGS may gain little before a large gain.
    static constexpr int kWindow = 3;

    /// @param start  value at the start of the descent [J]
    TOILE_HD void begin(double start)
    {
        count_ = 1;
        value_[0] = start;
    }

    /// Adds the value after another iteration [J].
    /// @return true if the last kWindow iterations together have gained less than `negligible` [J]
    TOILE_HD bool add_and_detect_stall(double value, double negligible)
    {
        double& before = value_[count_ % kWindow];
        const bool has_stalled = count_ >= kWindow && before - value < negligible;
        before = value;
        ++count_;
        return has_stalled;
    }

private:
    double value_[kWindow] = {};
    int count_ = 0;
};

} // namespace toile
