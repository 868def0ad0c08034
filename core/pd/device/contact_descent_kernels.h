#pragma once

#include "core/pd/device/descent_kernels.h"
#include "core/pd/device/two_loop.h"

namespace toile {

/// What a trial point tells: the objective there, what is to be known of the direction that led there, and of
/// the step that it would be.
struct ContactTrialSums {
    static constexpr int kLargest = 2; ///< of the numbers, the one that is a maximum

    double value = 0.0;          ///< [J]
    double slope = 0.0;          ///< [J] gradient . direction
    double largest_square = 0.0; ///< [m^2] of the direction's vectors: a maximum, not a sum
    StepError::Sums error;       ///< of gradient and direction; mass and driving are the step's and stay zero
    StepProducts products;

    TOILE_HD ContactTrialSums& operator+=(const ContactTrialSums& other)
    {
        value += other.value;
        slope += other.slope;
        largest_square = std::fmax(largest_square, other.largest_square);
        error += other.error;
        products += other.products;
        return *this;
    }
};

static_assert(offsetof(ContactTrialSums, largest_square) == ContactTrialSums::kLargest * sizeof(double));

struct MeasureContactTrial {
    DescentFields fields;
    PairCoefficients pairs;
    double step; ///< [-] of the direction; 0: the trial is where the descent begins

    TOILE_HD ContactTrialSums operator()(int i) const
    {
        ContactTrialSums sums;
        sums.value = fields.shares_of(i);
        if (step == 0.0)
            return sums;
        const Vec3 gradient = fields.here.gradient[i], d = unpadded(fields.direction[i]);
        sums.slope = gradient.dot(d);
        sums.largest_square = d.squaredNorm();
        sums.error.move = fields.masses[i] * sums.largest_square;
        sums.error.force = gradient.squaredNorm() / fields.masses[i];
        sums.error.opposing = gradient.dot(fields.drive[i]);

        const Vec3 s = step * d, g = fields.free_part(fields.trial.gradient, i), y = g - gradient;
        sums.products.sy = s.dot(y);
        sums.products.ss = s.squaredNorm();
        sums.products.yy = y.squaredNorm();
        sums.products.sg = s.dot(g);
        for (int j = 0; j < kHistory; ++j)
            if (j < pairs.count)
                sums.products.s_y[j] = unpadded(fields.s[fields.pair_of(pairs.slot[j], i)]).dot(y);
        return sums;
    }
};

/// The trial becomes the current point, and its step a pair.
struct TakePoint {
    DescentFields fields;
    int slot; ///< of the pair; -1: none

    TOILE_HD void operator()(int i) const
    {
        const Vec3 x = fields.trial.x[i], g = fields.free_part(fields.trial.gradient, i);
        if (slot >= 0) {
            const int pair = fields.pair_of(slot, i);
            fields.s[pair] = padded(x - fields.here.x[i]);
            fields.y[pair] = padded(g - fields.here.gradient[i]);
        }
        fields.here.x[i] = x;
        fields.here.gradient[i] = g;
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

    TOILE_HD InverseProducts operator()(int i) const
    {
        InverseProducts sums;
        for (int j = 0; j < kHistory; ++j)
            if (j < pairs.count)
                sums.y_z[j] = unpadded(fields.y[fields.pair_of(pairs.slot[j], i)]).dot(fields.here.z[i]);
        return sums;
    }
};

/// The direction z + sum_j of_j s_j.
struct AfterInverse {
    DescentFields fields;
    PairCoefficients of_s;

    TOILE_HD void operator()(int i) const
    {
        Vec3 d = fields.free_part(fields.here.z, i);
        for (int j = 0; j < kHistory; ++j)
            if (j < of_s.count)
                d += of_s.of[j] * unpadded(fields.s[fields.pair_of(of_s.slot[j], i)]);
        fields.direction[i] = padded(d);
    }
};

/// The trial point at `step` of the direction, and what others add their gradients to.
struct TryStep {
    DescentFields fields;
    double step; ///< [-]

    TOILE_HD void operator()(int i) const
    {
        fields.trial.x[i] = fields.here.x[i] + step * unpadded(fields.direction[i]);
        fields.begin_trial(i);
    }
};

} // namespace toile
