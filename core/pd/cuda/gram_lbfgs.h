#pragma once

#include <cmath>

#include "core/pd/minimiser/lbfgs.h"

namespace toile {

/// Dot products of the last step with the pairs of L-BFGS: all that a direction needs from the fields. s, y,
/// w: change of x, of the gradient g, and of z = B g; those with index j belong to the stored pairs, oldest
/// first.
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

/// L-BFGS with a fixed, linear inner operator B (Lbfgs accepts any). The two-loop recursion [Nocedal & Wright
/// 2006, alg. 7.4] runs over dot products instead of fields. Each pair (s, y) is stored with w = B y, so that
/// a direction
///
///   d = -z + sum_j ( of_s_j s_j - of_w_j w_j ),     z = B g
///
/// takes one reduction and one pass over the fields, and no application of B besides z. B need not be
/// symmetric.
///
/// The class holds numbers only; the caller stores the fields of the pairs, in slots [0, History). Pairs are
/// numbered by age, oldest first. All loops have a fixed length, so that the numbers stay in a GPU's
/// registers. Unused entries are skipped, not multiplied by 0, because they may be infinite.
template <int History>
class GramLbfgs {
public:
    TOILE_HD int count() const { return count_; }
    TOILE_HD void clear() { count_ = next_slot_ = 0; }

    /// Slot of the fields of pair k; an unused slot if k >= count().
    TOILE_HD int slot_of(int k) const
    {
        const int slot = next_slot_ - count_ + k;
        return slot < 0 ? slot + History : slot < History ? slot : slot - History;
    }

    /// Pair in a slot, the inverse of slot_of(); count() or more if the slot is unused.
    TOILE_HD int pair_in(int slot) const
    {
        const int k = slot - next_slot_ + count_;
        return k < 0 ? k + History : k < History ? k : k - History;
    }

    // Coefficients of pair k in the direction.
    TOILE_HD double of_s(int k) const { return of_s_[k]; }
    TOILE_HD double of_w(int k) const { return of_w_[k]; }

    /// Adds a step. Drops the oldest pair if all slots are used.
    /// @return the slot for the step's s, y and w; -1 if they are not kept
    TOILE_HD int add(const PairProducts<History>& step)
    {
        for (int j = 0; j < History; ++j)
            if (j < count_) {
                sg_[j] += step.s_y[j];
                yz_[j] += step.w_y[j];
            }
        if (!(step.sy > Lbfgs::kMinCurvature * std::sqrt(step.ss * step.yy)))
            return -1;
        const bool is_full = count_ == History;
        if (is_full)
            drop_oldest();
        const int slot = next_slot_;
        next_slot_ = (next_slot_ + 1) % History;
        for (int j = 0; j < History; ++j) // at pair j, the older ones are pairs 0 to j - 1
            if (j == count_)
                put(j, step, is_full);
        ++count_;
        return slot;
    }

    /// Computes the coefficients of the direction for the current g and z.
    TOILE_HD void find_direction()
    {
        // First loop, newest to oldest, over -g.
        for (int i = History - 1; i >= 0; --i) {
            double product = -sg_[i];
            for (int newer = i + 1; newer < History; ++newer)
                product -= newer < count_ ? of_w_[newer] * sy_[i][newer] : 0.0;
            of_w_[i] = i < count_ ? product * rho_[i] : 0.0;
        }

        // Second loop, oldest to newest, after applying B.
        for (int i = 0; i < History; ++i) {
            double product = -yz_[i];
            for (int other = 0; other < History; ++other)
                product -= other < count_ ? of_w_[other] * yw_[i][other] : 0.0;
            for (int older = 0; older < i; ++older)
                product += of_s_[older] * sy_[older][i];
            of_s_[i] = i < count_ ? of_w_[i] - product * rho_[i] : 0.0;
        }
    }

private:
    TOILE_HD void drop_oldest()
    {
        for (int i = 0; i + 1 < History; ++i) {
            for (int j = 0; j + 1 < History; ++j) {
                sy_[i][j] = sy_[i + 1][j + 1];
                yw_[i][j] = yw_[i + 1][j + 1];
            }
            sg_[i] = sg_[i + 1];
            yz_[i] = yz_[i + 1];
            rho_[i] = rho_[i + 1];
        }
        --count_;
    }

    /// Stores the step as pair k, after the others.
    /// @param has_dropped  the oldest pair was dropped after the products were taken
    TOILE_HD void put(int k, const PairProducts<History>& step, bool has_dropped)
    {
        for (int j = 0; j < History; ++j)
            if (j < k) {
                const int next = j + 1 < History ? j + 1 : j;
                sy_[j][k] = has_dropped ? step.s_y[next] : step.s_y[j];
                yw_[k][j] = has_dropped ? step.y_w[next] : step.y_w[j];
                yw_[j][k] = has_dropped ? step.w_y[next] : step.w_y[j];
            }
        sy_[k][k] = step.sy;
        yw_[k][k] = step.yw;
        sg_[k] = step.sg;
        yz_[k] = step.yz;
        rho_[k] = 1.0 / step.sy;
    }

    int count_ = 0, next_slot_ = 0;
    double sy_[History][History] = {}; ///< s_i . y_j if j is not older than i
    double yw_[History][History] = {}; ///< y_i . w_j
    double sg_[History] = {}, yz_[History] = {};
    double rho_[History] = {}; ///< 1 / (s . y)
    double of_s_[History] = {}, of_w_[History] = {};
};

} // namespace toile
