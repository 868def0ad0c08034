#pragma once

#include "core/compute/lanes.h"
#include "core/pd/cuda/descent_decisions.h"
#include "core/pd/step/step_kernels.h"

namespace toile {

/// Fields of a descent on a GPU. A point consists of a position, the objective's gradient g and z = B g; the
/// last two are ignored at fixed vertices.
struct DescentFields {
    struct Point {
        View<Vec3> x, gradient, z; ///< [vertices] [m], [N], [m]
    };

    Point here, trial;
    View<double> energy;             ///< [vertices and more] parts of the objective at the trial point [J]
    View<PaddedVec3> direction;      ///< [vertices] [m]
    View<PaddedVec3> s, y, w;        ///< [kHistory * vertices] the pairs, slot after slot; always finite
    View<const double> masses;       ///< [vertices] [kg]
    View<const unsigned char> fixed; ///< [vertices]
    View<const Vec3> drive;          ///< [vertices] q* - x0 [m]
    InertiaOfVertex inertia;         ///< at the trial point
    View<Descent> descent;           ///< [1]

    TOILE_HD int pair_of(int slot, int i) const { return slot * direction.size() + i; }
    TOILE_HD Vec3 free_part(const View<Vec3>& field, int i) const
    {
        const Vec3 local = field[i]; // loaded in parallel with the flag, not after it
        return fixed[i] ? Vec3(0.0, 0.0, 0.0) : local;
    }

    /// Sum of every n-th part of the energy from i on, with n vertices [J].
    TOILE_HD double partial_energy(int i) const
    {
        constexpr int kAtOnce = 4; // independent loads: there are twice as many triangles as vertices
        const int stride = direction.size();
        double sum = 0.0;
        for (int first = i; first < energy.size(); first += kAtOnce * stride) {
            double parts[kAtOnce];
            for (int k = 0; k < kAtOnce; ++k)
                parts[k] = first + k * stride < energy.size() ? energy[first + k * stride] : 0.0;
            for (const double part : parts)
                sum += part;
        }
        return sum;
    }

    /// Overwrites gradient and energy at the trial point with those of inertia; other terms add to them.
    TOILE_HD void begin_trial(int i) const { energy[i] = inertia(i); }
};

/// Contribution of vertex i to the sums of an evaluation.
struct MeasureTrial {
    DescentFields fields;

    /// Data of vertex i except z of the trial point, which the previous launch writes. Loaded before the
    /// wait, including unused pairs.
    struct Prologue {
        Vec3 gradient, z, new_gradient;
        PaddedVec3 direction, drive;
        PaddedVec3 s[kHistory], w[kHistory], y[kHistory];
        float mass;
        bool is_fixed;
        double value;
    };
    TOILE_HD Prologue prologue(int i) const
    {
        const Descent& descent = fields.descent[0];
        Prologue local{fields.here.gradient[i],
                       fields.here.z[i],
                       fields.free_part(fields.trial.gradient, i),
                       fields.direction[i],
                       padded(fields.drive[i]),
                       {},
                       {},
                       {},
                       float(fields.masses[i]),
                       fields.fixed[i] != 0,
                       fields.partial_energy(i)};
        for (int j = 0; j < kHistory; ++j) {
            const int pair = fields.pair_of(descent.pairs.slot_of(j), i);
            local.s[j] = fields.s[pair];
            local.w[j] = fields.w[pair];
            local.y[j] = fields.y[pair];
        }
        return local;
    }

    TOILE_HD TrialSums operator()(int i) const { return (*this)(i, prologue(i)); }
    TOILE_HD TrialSums operator()(int i, const Prologue& local) const
    {
        const Descent& descent = fields.descent[0];
        const Vec3 trial_z = fields.trial.z[i], new_z = local.is_fixed ? Vec3(0.0, 0.0, 0.0) : trial_z;
        TrialSums sums;
        sums.value = local.value;
        if (descent.action == Descent::Action::Start || descent.is_over)
            return sums;
        const Vec3 d = unpadded(local.direction);
        sums.slope = local.gradient.dot(d);

        // Products in single precision, as the pairs are; what cancels, y and w, has been subtracted before.
        const PaddedVec3 force = padded(local.gradient);
        sums.largest_square = dot(local.direction, local.direction);
        sums.error.move = double(local.mass) * sums.largest_square;
        sums.error.force = dot(force, force) / double(local.mass);
        sums.error.opposing = dot(force, local.drive);

        const PaddedVec3 s = padded(descent.search.step * d), y = padded(local.new_gradient - local.gradient);
        const PaddedVec3 w = padded(new_z - local.z);
        PairProducts<kHistory>& products = sums.products;
        products.sy = dot(s, y);
        products.ss = dot(s, s);
        products.yy = dot(y, y);
        products.yw = dot(y, w);
        products.sg = dot(s, padded(local.new_gradient));
        products.yz = dot(y, padded(new_z));
        for (int j = 0; j < kHistory; ++j) {
            products.s_y[j] = dot(local.s[j], y);
            products.y_w[j] = dot(local.w[j], y);
            products.w_y[j] = dot(local.y[j], w);
        }
        return sums;
    }
};

/// Takes the decision from the sums of an evaluation.
struct DecideOnTrial {
    View<Descent> descent; ///< [1]
    TOILE_HD void operator()(const TrialSums& sums) const
    {
        Descent next = descent[0]; // in registers: only one thread decides
        next.decide(sums);
        descent[0] = next;
    }
};

/// Applies the decision at vertex i, computes the next trial point, and begins its gradient.
struct TakeTrial {
    DescentFields fields;

    /// Data of vertex i, loaded while the previous launch still decides, including what some actions do not
    /// need. Pairs are loaded slot by slot, so that no address depends on the decision.
    struct Prologue {
        Vec3 x, gradient, z, trial_x, trial_gradient, trial_z, prediction;
        double inertia;
        PaddedVec3 s[kHistory], w[kHistory];
    };
    TOILE_HD Prologue prologue(int i) const
    {
        Prologue local{fields.here.x[i],
                       fields.here.gradient[i],
                       fields.here.z[i],
                       fields.trial.x[i],
                       fields.free_part(fields.trial.gradient, i),
                       fields.free_part(fields.trial.z, i),
                       fields.inertia.prediction[i],
                       fields.inertia.inertia[i],
                       {},
                       {}};
        for (int slot = 0; slot < kHistory; ++slot) {
            local.s[slot] = fields.s[fields.pair_of(slot, i)];
            local.w[slot] = fields.w[fields.pair_of(slot, i)];
        }
        return local;
    }

    TOILE_HD void operator()(int i) const { (*this)(i, prologue(i)); }
    TOILE_HD void operator()(int i, const Prologue& local) const
    {
        const Descent& descent = fields.descent[0];
        if (descent.action == Descent::Action::Rest)
            return;
        Vec3 x = local.x, d;
        if (descent.action == Descent::Action::Shorten) {
            d = unpadded(fields.direction[i]);
        } else if (descent.action == Descent::Action::Restart) {
            d = -local.z;
            fields.direction[i] = padded(d);
        } else {
            x = local.trial_x;
            d = take(descent, i, local);
        }
        const Vec3 next = x + descent.search.step * d;
        fields.trial.x[i] = next;
        fields.energy[i] = fields.inertia.at(i, next, local.prediction, local.inertia);
    }

private:
    /// @return the direction from the trial point
    TOILE_HD Vec3 take(const Descent& descent, int i, const Prologue& local) const
    {
        Vec3 d = direction(descent, local) - local.trial_z;
        if (descent.kept_slot >= 0) {
            // The newest pair is not in memory yet.
            const PaddedVec3 s = padded(local.trial_x - local.x), w = padded(local.trial_z - local.z);
            const int pair = fields.pair_of(descent.kept_slot, i), newest = descent.pairs.count() - 1;
            fields.y[pair] = padded(local.trial_gradient - local.gradient);
            fields.s[pair] = s;
            fields.w[pair] = w;
            d += descent.pairs.of_s(newest) * unpadded(s) - descent.pairs.of_w(newest) * unpadded(w);
        }
        fields.here.x[i] = local.trial_x;
        fields.here.gradient[i] = local.trial_gradient;
        fields.here.z[i] = local.trial_z;
        const PaddedVec3 rounded = padded(descent.is_over ? Vec3(0.0, 0.0, 0.0) : d);
        fields.direction[i] = rounded;
        return unpadded(rounded);
    }

    /// Contribution of the stored pairs to the direction.
    TOILE_HD static Vec3 direction(const Descent& descent, const Prologue& local)
    {
        Vec3 sum(0.0, 0.0, 0.0);
        for (int slot = 0; slot < kHistory; ++slot) {
            const int k = descent.pairs.pair_in(slot);
            if (k < descent.pairs.count() && slot != descent.kept_slot)
                sum += descent.pairs.of_s(k) * unpadded(local.s[slot]) -
                       descent.pairs.of_w(k) * unpadded(local.w[slot]);
        }
        return sum;
    }
};

} // namespace toile
