#pragma once

#include <cmath>

#include "core/pd/cuda/descent_decisions.h"

namespace toile {

/// Dot products of the last step s, which changed the gradient by y to g, with the stored pairs (oldest
/// first).
struct StepProducts {
    double sy = 0.0, ss = 0.0, yy = 0.0;
    double sg = 0.0;
    double s_y[kHistory] = {}; ///< s_j . y

    TOILE_HD StepProducts& operator+=(const StepProducts& other)
    {
        sy += other.sy;
        ss += other.ss;
        yy += other.yy;
        sg += other.sg;
        for (int j = 0; j < kHistory; ++j)
            s_y[j] += other.s_y[j];
        return *this;
    }
};

/// Coefficients of the pairs and their slots, by age; for kernels.
struct PairCoefficients {
    int count = 0;
    int slot[kHistory] = {};
    double of[kHistory] = {};
};

/// L-BFGS around an inverse that changes from step to step: the two-loop recursion [Nocedal & Wright 2006,
/// alg. 7.4] over dot products. Unlike GramLbfgs it has no product of the inverse with a pair, so a direction
/// takes one more reduction, between its loops. The caller stores the fields of the pairs, in slots.
class TwoLoop {
public:
    void clear() { count_ = next_slot_ = 0; }
    TOILE_HD int count() const { return count_; }

    /// Stored pairs, with coefficients of 0.
    TOILE_HD PairCoefficients pairs() const
    {
        PairCoefficients all;
        all.count = count_;
        for (int k = 0; k < count_; ++k)
            all.slot[k] = (next_slot_ - count_ + k + kHistory) % kHistory;
        return all;
    }

    /// Adds a step. Drops the oldest pair if all slots are used.
    /// @return the slot for the step's s and y; -1 if they are not kept
    int add(const StepProducts& step)
    {
        for (int j = 0; j < count_; ++j)
            sg_[j] += step.s_y[j];
        if (!(step.sy > Lbfgs::kMinCurvature * std::sqrt(step.ss * step.yy)))
            return -1;
        const bool is_full = count_ == kHistory;
        if (is_full)
            drop_oldest();
        for (int j = 0; j < count_; ++j)
            sy_[j][count_] = step.s_y[is_full ? j + 1 : j];
        sy_[count_][count_] = step.sy;
        sg_[count_] = step.sg;
        ++count_;
        const int slot = next_slot_;
        next_slot_ = (next_slot_ + 1) % kHistory;
        return slot;
    }

    /// Coefficients before the inverse: q = -g - sum_j of_j y_j.
    PairCoefficients before() const
    {
        PairCoefficients alpha = pairs();
        for (int i = count_ - 1; i >= 0; --i) {
            double product = -sg_[i];
            for (int newer = i + 1; newer < count_; ++newer)
                product -= alpha.of[newer] * sy_[i][newer];
            alpha.of[i] = product / sy_[i][i];
        }
        return alpha;
    }

    /// Coefficients after the inverse, z = B q: the direction is z + sum_j of_j s_j.
    /// @param y_z  y_j . z
    TOILE_HD PairCoefficients after(const PairCoefficients& alpha, const double (&y_z)[kHistory]) const
    {
        PairCoefficients of_s = pairs();
        for (int i = 0; i < count_; ++i) {
            double product = y_z[i];
            for (int older = 0; older < i; ++older)
                product += of_s.of[older] * sy_[older][i];
            of_s.of[i] = alpha.of[i] - product / sy_[i][i];
        }
        return of_s;
    }

private:
    void drop_oldest()
    {
        for (int i = 0; i + 1 < count_; ++i) {
            for (int j = i; j + 1 < count_; ++j)
                sy_[i][j] = sy_[i + 1][j + 1];
            sg_[i] = sg_[i + 1];
        }
        --count_;
    }

    int count_ = 0, next_slot_ = 0;
    double sy_[kHistory][kHistory] = {}; ///< s_i . y_j if j is not older than i
    double sg_[kHistory] = {};           ///< s_i . g
};

} // namespace toile
