#pragma once

#include "core/backend/lanes.h"
#include "core/pd/device/descent.h"
#include "core/pd/step_kernels.h"

namespace toile {

/// The fields of a descent on a GPU. A point is a position, the objective's gradient g and z = B g there;
/// neither counts at fixed vertices.
struct DescentFields {
    struct Point {
        View<Vec3> x, gradient, z; ///< [vertices] [m], [N], [m]
    };

    Point here, trial;
    View<double> energy;        ///< [vertices and more] shares of the objective at the trial point [J]
    View<PaddedVec3> direction; ///< [vertices] [m]
    View<PaddedVec3> s, y, w;   ///< [kHistory * vertices] the pairs, slot after slot; finite from the start
    View<const double> masses;  ///< [vertices] [kg]
    View<const unsigned char> fixed; ///< [vertices]
    View<const Vec3> drive;          ///< [vertices] q* - x0 [m]
    InertiaOfVertex inertia;         ///< at the trial point
    View<Descent> descent;           ///< [1]

    TOILE_HD int pair_of(int slot, int i) const { return slot * direction.size() + i; }
    TOILE_HD Vec3 free_part(const View<Vec3>& field, int i) const
    {
        const Vec3 own = field[i]; // loaded beside the flag, not after it
        return fixed[i] ? Vec3(0.0, 0.0, 0.0) : own;
    }

    /// Vertex i sums every n-th share, n vertices.
    TOILE_HD double shares_of(int i) const
    {
        constexpr int kAtOnce = 4; // loads that don't wait for each other: triangles are twice the vertices
        const int stride = direction.size();
        double sum = 0.0;
        for (int first = i; first < energy.size(); first += kAtOnce * stride) {
            double shares[kAtOnce];
            for (int k = 0; k < kAtOnce; ++k)
                shares[k] = first + k * stride < energy.size() ? energy[first + k * stride] : 0.0;
            for (const double share : shares)
                sum += share;
        }
        return sum;
    }

    /// Writes gradient and energy of inertia where the trial point now is: what others add to.
    TOILE_HD void begin_trial(int i) const { energy[i] = inertia(i); }
};

/// What vertex i adds to the sums of a turn.
struct MeasureTrial {
    DescentFields fields;

    /// All that vertex i has but z of the trial point, which the launch before finds: loaded before anything
    /// is waited for, pairs that are not in use too.
    struct Early {
        Vec3 gradient, z, new_gradient;
        PaddedVec3 direction, drive;
        PaddedVec3 s[kHistory], w[kHistory], y[kHistory];
        float mass;
        bool is_fixed;
        double value;
    };
    TOILE_HD Early early(int i) const
    {
        const Descent& descent = fields.descent[0];
        Early own{fields.here.gradient[i],
                  fields.here.z[i],
                  fields.free_part(fields.trial.gradient, i),
                  fields.direction[i],
                  padded(fields.drive[i]),
                  {},
                  {},
                  {},
                  float(fields.masses[i]),
                  fields.fixed[i] != 0,
                  fields.shares_of(i)};
        for (int j = 0; j < kHistory; ++j) {
            const int pair = fields.pair_of(descent.pairs.slot_of(j), i);
            own.s[j] = fields.s[pair];
            own.w[j] = fields.w[pair];
            own.y[j] = fields.y[pair];
        }
        return own;
    }

    TOILE_HD TrialSums operator()(int i) const { return (*this)(i, early(i)); }
    TOILE_HD TrialSums operator()(int i, const Early& own) const
    {
        const Descent& descent = fields.descent[0];
        const Vec3 trial_z = fields.trial.z[i], new_z = own.is_fixed ? Vec3(0.0, 0.0, 0.0) : trial_z;
        TrialSums sums;
        sums.value = own.value;
        if (descent.action == Descent::Action::Start || descent.is_over)
            return sums;
        const Vec3 d = unpadded(own.direction);
        sums.slope = own.gradient.dot(d);

        // Products in single precision, as the pairs are; what cancels, y and w, has been subtracted before.
        const PaddedVec3 force = padded(own.gradient);
        sums.largest_square = dot(own.direction, own.direction);
        sums.error.move = double(own.mass) * sums.largest_square;
        sums.error.force = dot(force, force) / double(own.mass);
        sums.error.opposing = dot(force, own.drive);

        const PaddedVec3 s = padded(descent.search.step * d), y = padded(own.new_gradient - own.gradient);
        const PaddedVec3 w = padded(new_z - own.z);
        PairProducts<kHistory>& products = sums.products;
        products.sy = dot(s, y);
        products.ss = dot(s, s);
        products.yy = dot(y, y);
        products.yw = dot(y, w);
        products.sg = dot(s, padded(own.new_gradient));
        products.yz = dot(y, padded(new_z));
        for (int j = 0; j < kHistory; ++j) {
            products.s_y[j] = dot(own.s[j], y);
            products.y_w[j] = dot(own.w[j], y);
            products.w_y[j] = dot(own.y[j], w);
        }
        return sums;
    }
};

/// What becomes of the sums of a turn.
struct DecideOnTrial {
    View<Descent> descent; ///< [1]
    TOILE_HD void operator()(const TrialSums& sums) const
    {
        Descent next = descent[0]; // in registers: a single thread decides
        next.decide(sums);
        descent[0] = next;
    }
};

/// Does at vertex i what was decided, finds the next trial point, and begins its gradient.
struct TakeTrial {
    DescentFields fields;

    /// All that vertex i has, which is loaded while the launch before still decides; also what is seldom left
    /// out. Pairs slot after slot: no address waits for what is decided.
    struct Early {
        Vec3 x, gradient, z, trial_x, trial_gradient, trial_z, prediction;
        double mass;
        PaddedVec3 s[kHistory], w[kHistory];
    };
    TOILE_HD Early early(int i) const
    {
        Early own{fields.here.x[i],
                  fields.here.gradient[i],
                  fields.here.z[i],
                  fields.trial.x[i],
                  fields.free_part(fields.trial.gradient, i),
                  fields.free_part(fields.trial.z, i),
                  fields.inertia.prediction[i],
                  fields.masses[i],
                  {},
                  {}};
        for (int slot = 0; slot < kHistory; ++slot) {
            own.s[slot] = fields.s[fields.pair_of(slot, i)];
            own.w[slot] = fields.w[fields.pair_of(slot, i)];
        }
        return own;
    }

    TOILE_HD void operator()(int i) const { (*this)(i, early(i)); }
    TOILE_HD void operator()(int i, const Early& own) const
    {
        const Descent& descent = fields.descent[0];
        if (descent.action == Descent::Action::Rest)
            return;
        Vec3 x = own.x, d;
        if (descent.action == Descent::Action::Shorten) {
            d = unpadded(fields.direction[i]);
        } else if (descent.action == Descent::Action::Restart) {
            d = -own.z;
            fields.direction[i] = padded(d);
        } else {
            x = own.trial_x;
            d = take(descent, i, own);
        }
        const Vec3 next = x + descent.search.step * d;
        fields.trial.x[i] = next;
        fields.energy[i] = fields.inertia.at(i, next, own.prediction, own.mass);
    }

private:
    /// @return the direction from the trial point
    TOILE_HD Vec3 take(const Descent& descent, int i, const Early& own) const
    {
        Vec3 d = direction(descent, own) - own.trial_z;
        if (descent.kept_slot >= 0) {
            // The newest pair is not in memory yet.
            const PaddedVec3 s = padded(own.trial_x - own.x), w = padded(own.trial_z - own.z);
            const int pair = fields.pair_of(descent.kept_slot, i), newest = descent.pairs.count() - 1;
            fields.y[pair] = padded(own.trial_gradient - own.gradient);
            fields.s[pair] = s;
            fields.w[pair] = w;
            d += descent.pairs.of_s(newest) * unpadded(s) - descent.pairs.of_w(newest) * unpadded(w);
        }
        fields.here.x[i] = own.trial_x;
        fields.here.gradient[i] = own.trial_gradient;
        fields.here.z[i] = own.trial_z;
        const PaddedVec3 rounded = padded(descent.is_over ? Vec3(0.0, 0.0, 0.0) : d);
        fields.direction[i] = rounded;
        return unpadded(rounded);
    }

    /// What the pairs in memory add to it.
    TOILE_HD static Vec3 direction(const Descent& descent, const Early& own)
    {
        Vec3 sum(0.0, 0.0, 0.0);
        for (int slot = 0; slot < kHistory; ++slot) {
            const int k = descent.pairs.pair_in(slot);
            if (k < descent.pairs.count() && slot != descent.kept_slot)
                sum += descent.pairs.of_s(k) * unpadded(own.s[slot]) -
                       descent.pairs.of_w(k) * unpadded(own.w[slot]);
        }
        return sum;
    }
};

} // namespace toile
