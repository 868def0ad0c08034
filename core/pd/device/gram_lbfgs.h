#pragma once

#include <cmath>

#include "core/backend/types.h"

namespace toile {

/// Dot products of a step just taken with the pairs of L-BFGS: all that a direction needs of the fields.
/// s, y, w: change of x, of the gradient g, and of z = B g; numbered ones are of the pairs kept.
template <int History>
struct PairProducts {
    double sy = 0.0, ss = 0.0, yy = 0.0, yw = 0.0;
    double sg = 0.0, yz = 0.0; ///< with g and z after the step
    double s_y[History] = {};  ///< s_j . y
    double y_w[History] = {};  ///< y . w_j
    double w_y[History] = {};  ///< y_j . w

    TOILE_HD PairProducts& operator+=(const PairProducts& other)
    {
        sy += other.sy;
        ss += other.ss;
        yy += other.yy;
        yw += other.yw;
        sg += other.sg;
        yz += other.yz;
        for (int j = 0; j < History; ++j) {
            s_y[j] += other.s_y[j];
            y_w[j] += other.y_w[j];
            w_y[j] += other.w_y[j];
        }
        return *this;
    }
};

/// L-BFGS with a fixed, linear inner operator B (Lbfgs has any) in which the two-loop recursion [Nocedal &
/// Wright 2006, alg. 7.4] runs over dot products instead of fields: beside a pair (s, y) it keeps w = B y,
/// so that a direction
///
///   d = -z + sum_j ( of_s_j s_j - of_w_j w_j ),     z = B g
///
/// takes one reduction and one pass over the fields, and no application of B besides z. B need not be
/// symmetric.
///
/// It holds numbers only; fields of pair j are the caller's, in slot j of [0, History).
template <int History>
class GramLbfgs {
public:
    /// Pairs whose curvature s.y is below this share of |s||y| carry rounding, not curvature [-].
    static constexpr double kMinCurvature = 1e-10;

    TOILE_HD int count() const { return count_; } ///< slots in use are [0, count())
    TOILE_HD void clear() { count_ = next_ = 0; }
    TOILE_HD double of_s(int slot) const { return of_s_[slot]; }
    TOILE_HD double of_w(int slot) const { return of_w_[slot]; }

    /// Learns of a step. The oldest pair goes where there is no room.
    /// @return the slot where the step's s, y and w belong; -1 where they are not kept
    TOILE_HD int add(const PairProducts<History>& step)
    {
        for (int j = 0; j < count_; ++j) {
            sg_[j] += step.s_y[j];
            yz_[j] += step.w_y[j];
        }
        if (!(step.sy > kMinCurvature * std::sqrt(step.ss * step.yy)))
            return -1;
        const int slot = next_;
        next_ = (next_ + 1) % History;
        count_ = count_ < History ? count_ + 1 : History;
        for (int j = 0; j < count_; ++j) {
            sy_[j][slot] = step.s_y[j];
            yw_[slot][j] = step.y_w[j];
            yw_[j][slot] = step.w_y[j];
        }
        sy_[slot][slot] = step.sy;
        yw_[slot][slot] = step.yw;
        sg_[slot] = step.sg;
        yz_[slot] = step.yz;
        return slot;
    }

    /// Finds the coefficients of the direction for the current g and z.
    TOILE_HD void find_direction()
    {
        // First loop, newest to oldest: what becomes of -g.
        for (int k = count_ - 1; k >= 0; --k) {
            const int i = slot_of(k);
            double product = -sg_[i];
            for (int newer = k + 1; newer < count_; ++newer)
                product -= of_w_[slot_of(newer)] * sy_[i][slot_of(newer)];
            of_w_[i] = product / sy_[i][i];
        }

        // Second loop, oldest to newest, after B has been applied.
        for (int k = 0; k < count_; ++k) {
            const int i = slot_of(k);
            double product = -yz_[i];
            for (int other = 0; other < count_; ++other)
                product -= of_w_[slot_of(other)] * yw_[i][slot_of(other)];
            for (int older = 0; older < k; ++older)
                product += of_s_[slot_of(older)] * sy_[slot_of(older)][i];
            of_s_[i] = of_w_[i] - product / sy_[i][i];
        }
    }

private:
    /// Slot of the k-th pair, the oldest first.
    TOILE_HD int slot_of(int k) const { return (next_ - count_ + k + History) % History; }

    int count_ = 0, next_ = 0;
    double sy_[History][History] = {}; ///< s_i . y_j where j is not older than i
    double yw_[History][History] = {}; ///< y_i . w_j
    double sg_[History] = {}, yz_[History] = {};
    double of_s_[History] = {}, of_w_[History] = {};
};

} // namespace toile
