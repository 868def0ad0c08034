#pragma once

#include "core/backend/types.h"

namespace toile {

/// The objective at the last points of a descent: tells when going on is no longer worth it.
class RecentValues {
public:
    /// Iterations that are looked at together: single ones of L-BFGS may gain little on the way to much.
    static constexpr int kWindow = 3;

    /// @param start  the objective where the descent begins [J]
    TOILE_HD void begin(double start)
    {
        count_ = 1;
        value_[0] = start;
    }

    /// Takes the objective after another iteration [J].
    /// @return true when the last kWindow iterations together have gained less than `negligible` [J]
    TOILE_HD bool add_and_tell_stall(double value, double negligible)
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
