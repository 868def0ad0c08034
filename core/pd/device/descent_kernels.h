#pragma once

#include "core/backend/lanes.h"
#include "core/pd/device/descent.h"

namespace toile {

/// The fields of a descent on a GPU. A point is a position, the objective's gradient g and z = B g there.
struct DescentFields {
    struct Point {
        View<Vec3> x, gradient, z; ///< [vertices] [m], [N], [m]
    };

    Point here, trial;
    View<double> energy;        ///< [vertices] shares of the objective at the trial point [J]
    View<PaddedVec3> direction; ///< [vertices] [m]
    View<PaddedVec3> s, y, w;   ///< [kHistory * vertices] the pairs, slot after slot
    View<const double> masses;  ///< [vertices] [kg]
    View<const Vec3> drive;     ///< [vertices] q* - x0 [m]
    View<Descent> descent;      ///< [1]

    TOILE_HD int pair_of(int slot, int i) const { return slot * direction.size() + i; }
};

/// What vertex i adds to the sums of a turn.
struct MeasureTrial {
    DescentFields fields;

    TOILE_HD TrialSums operator()(int i) const
    {
        const Descent& descent = fields.descent[0];
        TrialSums sums;
        sums.value = fields.energy[i];
        if (descent.action == Descent::Action::Start || descent.is_over)
            return sums;
        const Vec3 gradient = fields.here.gradient[i], d = unpadded(fields.direction[i]);
        sums.slope = gradient.dot(d);
        sums.largest_square = d.squaredNorm();
        sums.error.move = fields.masses[i] * sums.largest_square;
        sums.error.force = gradient.squaredNorm() / fields.masses[i];
        sums.error.opposing = gradient.dot(fields.drive[i]);

        const Vec3 s = descent.search.step * d;
        const Vec3 y = fields.trial.gradient[i] - gradient, w = fields.trial.z[i] - fields.here.z[i];
        PairProducts<kHistory>& products = sums.products;
        products.sy = s.dot(y);
        products.ss = s.squaredNorm();
        products.yy = y.squaredNorm();
        products.yw = y.dot(w);
        products.sg = s.dot(fields.trial.gradient[i]);
        products.yz = y.dot(fields.trial.z[i]);
        for (int j = 0; j < kHistory; ++j) {
            if (j >= descent.pairs.count())
                break;
            const int pair = fields.pair_of(j, i);
            products.s_y[j] = unpadded(fields.s[pair]).dot(y);
            products.y_w[j] = unpadded(fields.w[pair]).dot(y);
            products.w_y[j] = unpadded(fields.y[pair]).dot(w);
        }
        return sums;
    }
};

/// What becomes of the sums of a turn.
struct DecideOnTrial {
    View<Descent> descent; ///< [1]
    TOILE_HD void operator()(const TrialSums& sums) const { descent[0].decide(sums); }
};

/// Does at vertex i what was decided, and finds the next trial point.
struct TakeTrial {
    DescentFields fields;

    TOILE_HD void operator()(int i) const
    {
        const Descent& descent = fields.descent[0];
        switch (descent.action) {
        case Descent::Action::Rest:
            return;
        case Descent::Action::Shorten:
            break;
        case Descent::Action::Restart:
            fields.direction[i] = padded(-fields.here.z[i]);
            break;
        default:
            take(descent, i);
        }
        fields.trial.x[i] = fields.here.x[i] + descent.search.step * unpadded(fields.direction[i]);
    }

private:
    TOILE_HD void take(const Descent& descent, int i) const
    {
        const Vec3 gradient = fields.trial.gradient[i], z = fields.trial.z[i];
        if (descent.kept_slot >= 0) {
            const int pair = fields.pair_of(descent.kept_slot, i);
            fields.s[pair] = padded(fields.trial.x[i] - fields.here.x[i]);
            fields.y[pair] = padded(gradient - fields.here.gradient[i]);
            fields.w[pair] = padded(z - fields.here.z[i]);
        }
        fields.here.x[i] = fields.trial.x[i];
        fields.here.gradient[i] = gradient;
        fields.here.z[i] = z;

        Vec3 d = -z;
        for (int j = 0; j < descent.pairs.count(); ++j) {
            const int pair = fields.pair_of(j, i);
            d += descent.pairs.of_s(j) * unpadded(fields.s[pair]) -
                 descent.pairs.of_w(j) * unpadded(fields.w[pair]);
        }
        fields.direction[i] = padded(descent.is_over ? Vec3(Vec3::Zero()) : d);
    }
};

} // namespace toile
