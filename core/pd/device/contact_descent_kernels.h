#pragma once

#include "core/pd/device/descent_kernels.h"
#include "core/pd/device/device_active_set.h"
#include "core/pd/device/two_loop.h"

namespace toile {

/// What a trial point tells: the objective there, what is to be known of the direction that led there, and of
/// the step that it would be.
struct ContactTrialSums {
    static constexpr int kLargest = 2; ///< of the numbers, the one that is a maximum

    double value = 0.0;          ///< [J]
    double slope = 0.0;          ///< [J] gradient . direction
    double largest_square = 0.0; ///< [m^2] of the direction's vectors: a maximum, not a sum
    double acting = 0.0;         ///< terms of contact that act there, each at every vertex of its own
    StepError::Sums error;       ///< of gradient and direction; mass and driving are the step's and stay zero
    StepProducts products;

    TOILE_HD ContactTrialSums& operator+=(const ContactTrialSums& other)
    {
        value += other.value;
        slope += other.slope;
        largest_square = std::fmax(largest_square, other.largest_square);
        acting += other.acting;
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
    double step; ///< [-] of the direction; 0: the trial is where the descent begins

    /// All but what the trial's energies and contact write.
    struct Early {
        Vec3 gradient, drive;
        PaddedVec3 direction;
        double mass;
        int list;
        PaddedVec3 s[kHistory];
    };
    TOILE_HD Early early(int i) const
    {
        Early own{fields.here.gradient[i], fields.drive[i],    fields.direction[i],
                  fields.masses[i],        contact.list_of[i], {}};
        for (int j = 0; j < kHistory; ++j)
            own.s[j] = fields.s[fields.pair_of(pairs.slot[j], i)];
        return own;
    }

    TOILE_HD ContactTrialSums operator()(int i) const { return (*this)(i, early(i)); }
    TOILE_HD ContactTrialSums operator()(int i, const Early& own) const
    {
        ContactTrialSums sums;
        sums.value = fields.shares_of(i);
        sums.acting = own.list > 0 ? contact.acting[own.list - 1] : 0;
        if (step == 0.0)
            return sums;
        const Vec3 d = unpadded(own.direction);
        sums.slope = own.gradient.dot(d);
        sums.largest_square = d.squaredNorm();
        sums.error.move = own.mass * sums.largest_square;
        sums.error.force = own.gradient.squaredNorm() / own.mass;
        sums.error.opposing = own.gradient.dot(own.drive);

        const Vec3 s = step * d, g = fields.free_part(fields.trial.gradient, i), y = g - own.gradient;
        sums.products.sy = s.dot(y);
        sums.products.ss = s.squaredNorm();
        sums.products.yy = y.squaredNorm();
        sums.products.sg = s.dot(g);
        for (int j = 0; j < kHistory; ++j)
            if (j < pairs.count)
                sums.products.s_y[j] = unpadded(own.s[j]).dot(y);
        return sums;
    }
};

/// q = -g - sum_j alpha_j y_j, what the inverse is applied to: into trial.z, which is free until then.
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

/// The trial becomes the current point, and its step a pair; begins a direction from there.
struct TakePoint {
    BeforeInverse before_inverse; ///< alpha with the pair
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

/// y_j . z of all pairs, with here.z what the inverse made of q.
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

    /// The pairs, which the inverse leaves as they are.
    struct Early {
        PaddedVec3 y[kHistory];
    };
    TOILE_HD Early early(int i) const
    {
        Early own;
        for (int j = 0; j < kHistory; ++j)
            own.y[j] = fields.y[fields.pair_of(pairs.slot[j], i)];
        return own;
    }

    TOILE_HD InverseProducts operator()(int i) const { return (*this)(i, early(i)); }
    TOILE_HD InverseProducts operator()(int i, const Early& own) const
    {
        const Vec3 z = fields.here.z[i];
        InverseProducts sums;
        for (int j = 0; j < kHistory; ++j)
            if (j < pairs.count)
                sums.y_z[j] = unpadded(own.y[j]).dot(z);
        return sums;
    }
};

/// What becomes of them: coefficients of the pairs' steps.
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

/// The trial point at `step` of the direction, and what others add their gradients to.
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

/// The direction z + sum_j of_j s_j, and a step of it.
struct AfterInverse {
    TryStep trial;
    PairCoefficients pairs;
    View<const double> of_s; ///< [kHistory]

    /// All but what the inverse finds.
    struct Early {
        Vec3 x;
        PaddedVec3 s[kHistory];
    };
    TOILE_HD Early early(int i) const
    {
        const DescentFields& fields = trial.fields;
        Early own{fields.here.x[i], {}};
        for (int j = 0; j < kHistory; ++j)
            own.s[j] = fields.s[fields.pair_of(pairs.slot[j], i)];
        return own;
    }

    TOILE_HD void operator()(int i) const { (*this)(i, early(i)); }
    TOILE_HD void operator()(int i, const Early& own) const
    {
        Vec3 sum = trial.fields.free_part(trial.fields.here.z, i);
        for (int j = 0; j < kHistory; ++j)
            if (j < pairs.count)
                sum += of_s[j] * unpadded(own.s[j]);
        const PaddedVec3 direction = padded(sum);
        trial.fields.direction[i] = direction;
        trial.from(i, own.x, direction);
    }
};

} // namespace toile
