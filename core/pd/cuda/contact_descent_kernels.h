#pragma once

#include "core/pd/cuda/active_set.h"
#include "core/pd/cuda/descent_kernels.h"
#include "core/pd/cuda/two_loop.h"

namespace toile {

/// Sums at a trial point: the objective, measures of its direction, and products of the step for L-BFGS.
struct ContactTrialSums {
    static constexpr int kLargest = 2; ///< index of the number that is a maximum

    double value = 0.0;          ///< [J]
    double slope = 0.0;          ///< [J] gradient . direction
    double largest_square = 0.0; ///< [m^2] of the direction's vectors: a maximum, not a sum
    double active_count = 0.0;   ///< active contact terms, counted at each of their vertices
    StepError::Sums error;       ///< of gradient and direction; mass and driving are the step's and stay zero
    StepProducts products;

    TOILE_HD ContactTrialSums& operator+=(const ContactTrialSums& other)
    {
        value += other.value;
        slope += other.slope;
        largest_square = std::fmax(largest_square, other.largest_square);
        active_count += other.active_count;
        error += other.error;
        products += other.products;
        return *this;
    }
};

static_assert(offsetof(ContactTrialSums, largest_square) == ContactTrialSums::kLargest * sizeof(double));

struct MeasureContactTrial {
    DescentFields fields;
    DeviceActiveSet::Frozen contact;
    PairCoefficients pairs;
    double step; ///< [-] along the direction; 0: the trial is the start of the descent

    /// Data that the trial's energies and contact do not write.
    struct Prologue {
        Vec3 gradient, drive;
        PaddedVec3 direction;
        double mass;
        int list;
        PaddedVec3 s[kHistory];
    };
    TOILE_HD Prologue prologue(int i) const
    {
        Prologue local{fields.here.gradient[i], fields.drive[i],    fields.direction[i],
                       fields.masses[i],        contact.list_of[i], {}};
        for (int j = 0; j < kHistory; ++j)
            local.s[j] = fields.s[fields.pair_of(pairs.slot[j], i)];
        return local;
    }

    TOILE_HD ContactTrialSums operator()(int i) const { return (*this)(i, prologue(i)); }
    TOILE_HD ContactTrialSums operator()(int i, const Prologue& local) const
    {
        ContactTrialSums sums;
        sums.value = fields.partial_energy(i);
        sums.active_count = local.list >= 0 ? contact.rows.active_count[local.list] : 0;
        if (step == 0.0)
            return sums;
        const Vec3 d = unpadded(local.direction);
        sums.slope = local.gradient.dot(d);
        sums.largest_square = d.squaredNorm();
        sums.error.move = local.mass * sums.largest_square;
        sums.error.force = local.gradient.squaredNorm() / local.mass;
        sums.error.opposing = local.gradient.dot(local.drive);

        const Vec3 s = step * d, g = fields.free_part(fields.trial.gradient, i), y = g - local.gradient;
        sums.products.sy = s.dot(y);
        sums.products.ss = s.squaredNorm();
        sums.products.yy = y.squaredNorm();
        sums.products.sg = s.dot(g);
        for (int j = 0; j < kHistory; ++j)
            if (j < pairs.count)
                sums.products.s_y[j] = unpadded(local.s[j]).dot(y);
        return sums;
    }
};

/// Input of the inverse, q = -g - sum_j alpha_j y_j, into trial.z, which is unused until then.
struct BeforeInverse {
    DescentFields fields;
    PairCoefficients alpha;

    TOILE_HD void operator()(int i) const
    {
        Vec3 sum = -fields.here.gradient[i];
        for (int j = 0; j < kHistory; ++j)
            if (j < alpha.count)
                sum -= alpha.of[j] * unpadded(fields.y[fields.pair_of(alpha.slot[j], i)]);
        fields.trial.z[i] = fields.fixed[i] ? Vec3(0.0, 0.0, 0.0) : sum;
    }
};

/// Makes the trial the current point and its step a pair, and begins a direction from there.
struct TakePoint {
    BeforeInverse before_inverse; ///< alpha after adding the pair
    int slot;                     ///< of the pair; -1: none

    TOILE_HD void operator()(int i) const
    {
        const DescentFields& fields = before_inverse.fields;
        const Vec3 x = fields.trial.x[i], g = fields.free_part(fields.trial.gradient, i);
        if (slot >= 0) {
            const int pair = fields.pair_of(slot, i);
            fields.s[pair] = padded(x - fields.here.x[i]);
            fields.y[pair] = padded(g - fields.here.gradient[i]);
        }
        fields.here.x[i] = x;
        fields.here.gradient[i] = g;
        before_inverse(i);
    }
};

/// Products y_j . z with all pairs; here.z holds z, the inverse applied to q.
struct InverseProducts {
    static constexpr int kLargest = -1;

    double y_z[kHistory] = {};

    TOILE_HD InverseProducts& operator+=(const InverseProducts& other)
    {
        for (int j = 0; j < kHistory; ++j)
            y_z[j] += other.y_z[j];
        return *this;
    }
};

struct MeasureInverse {
    DescentFields fields;
    PairCoefficients pairs;

    /// Pairs, which the inverse does not write.
    struct Prologue {
        PaddedVec3 y[kHistory];
    };
    TOILE_HD Prologue prologue(int i) const
    {
        Prologue local;
        for (int j = 0; j < kHistory; ++j)
            local.y[j] = fields.y[fields.pair_of(pairs.slot[j], i)];
        return local;
    }

    TOILE_HD InverseProducts operator()(int i) const { return (*this)(i, prologue(i)); }
    TOILE_HD InverseProducts operator()(int i, const Prologue& local) const
    {
        const Vec3 z = fields.here.z[i];
        InverseProducts sums;
        for (int j = 0; j < kHistory; ++j)
            if (j < pairs.count)
                sums.y_z[j] = unpadded(local.y[j]).dot(z);
        return sums;
    }
};

/// Computes from these products the coefficients of the pairs' steps.
struct FindCoefficients {
    TwoLoop pairs;
    PairCoefficients alpha;
    View<double> of_s; ///< [kHistory] out

    TOILE_HD void operator()(const InverseProducts& sums) const
    {
        const PairCoefficients found = pairs.after(alpha, sums.y_z);
        for (int j = 0; j < kHistory; ++j)
            of_s[j] = found.of[j];
    }
};

/// Sets the trial point at `step` along the direction, and begins its gradient.
struct TryStep {
    DescentFields fields;
    double step; ///< [-]

    TOILE_HD void operator()(int i) const { from(i, fields.here.x[i], fields.direction[i]); }
    TOILE_HD void from(int i, const Vec3& here, const PaddedVec3& direction) const
    {
        fields.trial.x[i] = here + step * unpadded(direction);
        fields.begin_trial(i);
    }
};

/// Computes the direction z + sum_j of_j s_j and takes a step along it.
struct AfterInverse {
    TryStep trial;
    PairCoefficients pairs;
    View<const double> of_s; ///< [kHistory]

    /// Data that the inverse does not write.
    struct Prologue {
        Vec3 x;
        PaddedVec3 s[kHistory];
    };
    TOILE_HD Prologue prologue(int i) const
    {
        const DescentFields& fields = trial.fields;
        Prologue local{fields.here.x[i], {}};
        for (int j = 0; j < kHistory; ++j)
            local.s[j] = fields.s[fields.pair_of(pairs.slot[j], i)];
        return local;
    }

    TOILE_HD void operator()(int i) const { (*this)(i, prologue(i)); }
    TOILE_HD void operator()(int i, const Prologue& local) const
    {
        Vec3 sum = trial.fields.free_part(trial.fields.here.z, i);
        for (int j = 0; j < kHistory; ++j)
            if (j < pairs.count)
                sum += of_s[j] * unpadded(local.s[j]);
        const PaddedVec3 direction = padded(sum);
        trial.fields.direction[i] = direction;
        trial.from(i, local.x, direction);
    }
};

} // namespace toile
