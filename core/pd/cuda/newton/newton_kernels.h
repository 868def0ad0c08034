#pragma once

/// Kernels of DeviceNewton: trial points, and sums over them.

#include <cmath>

#include "core/compute/lanes.h"
#include "core/pd/cuda/newton/hessian_kernels.h"
#include "core/pd/step/step_kernels.h"

namespace toile {

/// Starts a trial point: the gradient of its inertia, to which other terms add.
struct BeginNewtonTrial {
    InertiaOfVertex inertia; ///< at the trial point
    View<double> energy;     ///< [vertices and more] out [J]

    TOILE_HD void at(int i, const Vec3& x, View<Vec3> trial) const
    {
        trial[i] = x;
        energy[i] = inertia.at(i, x, inertia.prediction[i], inertia.inertia[i]);
    }
};

/// The current point as the trial point.
struct TryHere {
    View<const Vec3> x;
    View<Vec3> trial;
    BeginNewtonTrial begin;
    TOILE_HD void operator()(int i) const { begin.at(i, x[i], trial); }
};

/// Makes the trial point the current one, and keeps where that was.
struct MakeCurrent {
    View<const Vec3> trial; ///< [vertices] [m]
    View<Vec3> x, before;   ///< [vertices] [m] out
    TOILE_HD void operator()(int i) const
    {
        before[i] = x[i];
        x[i] = trial[i];
    }
};

/// Makes another point along the direction the trial point and the current one.
struct Retake {
    View<const Vec3> before;          ///< [vertices] [m] where the direction begins
    View<const PaddedVec3> direction; ///< [vertices] [m]
    double length;                    ///< [-]
    View<Vec3> trial, x;              ///< [vertices] [m] out
    TOILE_HD void operator()(int i) const { x[i] = trial[i] = before[i] + length * unpadded(direction[i]); }
};

/// A step of some length along the direction.
struct TryAlong {
    View<const Vec3> x;
    View<const PaddedVec3> direction;
    double length; ///< [-]
    View<Vec3> trial;
    BeginNewtonTrial begin;
    TOILE_HD void operator()(int i) const
    {
        begin.at(i, Vec3(x[i] + length * unpadded(direction[i])), trial);
    }
};

/// No motion.
struct TryRest {
    View<const Vec3> start, prediction;
    View<const unsigned char> fixed;
    View<Vec3> trial;
    BeginNewtonTrial begin;
    TOILE_HD void operator()(int i) const { begin.at(i, fixed[i] != 0 ? prediction[i] : start[i], trial); }
};

/// A local and a global step.
struct TryLocalGlobal {
    View<const Vec3> x, z; ///< z = H^-1 g [m]
    View<const unsigned char> fixed;
    View<Vec3> trial;
    BeginNewtonTrial begin;
    TOILE_HD void operator()(int i) const
    {
        begin.at(i, fixed[i] != 0 ? Vec3(x[i]) : Vec3(x[i] - z[i]), trial);
    }
};

/// Copies gradients, zero where fixed.
struct CopyFreeGradient {
    View<const Vec3> gradient;
    View<const unsigned char> fixed;
    View<Vec3> to;
    TOILE_HD void operator()(int i) const { to[i] = fixed[i] != 0 ? Vec3(0.0, 0.0, 0.0) : Vec3(gradient[i]); }
};

/// Sums at a trial point.
struct NewtonTrialSums {
    static constexpr int kLargest = 0; ///< index of the number that is a maximum

    double largest_square = 0.0;  ///< [m^2] of the direction's vectors: a maximum, not a sum
    double value = 0.0;           ///< [J]
    double slope = 0.0;           ///< [J] gradient . direction
    double end_slope = 0.0;       ///< [J] likewise at the trial point
    double weighted_square = 0.0; ///< [kg m^2] weight times squared direction
    double bound = 0.0;           ///< [J] squared gradient over inertia, at least d . K d, at the trial point

    TOILE_HD NewtonTrialSums& operator+=(const NewtonTrialSums& other)
    {
        largest_square = std::fmax(largest_square, other.largest_square);
        value += other.value;
        slope += other.slope;
        end_slope += other.end_slope;
        weighted_square += other.weighted_square;
        bound += other.bound;
        return *this;
    }
};

struct MeasureNewtonTrial {
    View<const double> energy;           ///< [vertices and more] parts of the value [J]
    View<const Vec3> gradient;           ///< [vertices] at the current point [N]
    View<const Vec3> trial_gradient;     ///< [vertices] [N]
    View<const PaddedVec3> direction;    ///< [vertices] [m]
    View<const double> weights, inertia; ///< [vertices] [kg], [N/m]
    View<const unsigned char> fixed;     ///< [vertices]

    TOILE_HD NewtonTrialSums operator()(int i) const
    {
        NewtonTrialSums sums;
        for (int k = i; k < energy.size(); k += weights.size())
            sums.value += energy[k];
        if (fixed[i] != 0)
            return sums;
        const Vec3 d = unpadded(direction[i]);
        sums.largest_square = d.squaredNorm();
        sums.slope = gradient[i].dot(d);
        sums.end_slope = trial_gradient[i].dot(d);
        sums.weighted_square = weights[i] * sums.largest_square;
        sums.bound = trial_gradient[i].squaredNorm() / inertia[i];
        return sums;
    }
};

/// Begins the model of the objective with contact as it is ahead: the direction base + length * correction,
/// and the point there.
struct BeginModel {
    View<const Vec3> x;
    View<const PaddedVec3> base, correction;
    double length; ///< [-]
    View<PaddedVec3> direction;
    View<Vec3> ahead, contact_gradient; ///< the latter zero, to add to
    View<double> contact_energy;        ///< [vertices] likewise

    TOILE_HD void operator()(int i) const
    {
        PaddedVec3 d = base[i];
        d += float(length) * correction[i];
        direction[i] = d;
        ahead[i] = x[i] + unpadded(d);
        contact_gradient[i] = Vec3(0.0, 0.0, 0.0);
        contact_energy[i] = 0.0;
    }
};

/// Sums of the model: its value is elastic + contact, less contact's at the current point.
struct ModelSums {
    static constexpr int kLargest = -1;

    double elastic = 0.0, contact = 0.0; ///< [J]

    TOILE_HD ModelSums& operator+=(const ModelSums& other)
    {
        elastic += other.elastic;
        contact += other.contact;
        return *this;
    }
};

/// Evaluates the model, and its gradient.
struct MeasureModel {
    SlicedHessian hessian;
    View<const PaddedVec3> direction;
    View<const Vec3> gradient;         ///< [vertices] at the current point, without contact [N]
    View<const Vec3> contact_gradient; ///< [vertices] ahead [N]
    View<const double> contact_energy; ///< [vertices] ahead [J]
    View<const unsigned char> fixed;
    View<Vec3> model_gradient; ///< [vertices] out [N]

    TOILE_HD ModelSums operator()(int i) const
    {
        ModelSums sums;
        sums.contact = contact_energy[i];
        if (fixed[i] != 0) {
            model_gradient[i] = Vec3(0.0, 0.0, 0.0);
            return sums;
        }
        const Vec3 product = unpadded(hessian.times(i, direction)), d = unpadded(direction[i]);
        sums.elastic = (gradient[i] + 0.5 * product).dot(d);
        model_gradient[i] = gradient[i] + product + contact_gradient[i];
        return sums;
    }
};

/// Removes contact's part from a gradient, and sums contact's energy.
struct RemoveContact {
    View<const Vec3> gradient, contact_gradient;
    View<const double> contact_energy;
    View<Vec3> rest; ///< [vertices] out [N]

    TOILE_HD double operator()(int i) const
    {
        rest[i] = gradient[i] - contact_gradient[i];
        return contact_energy[i];
    }
};

/// Twice the decrease that a direction promises with this gradient [J].
struct PromisedDecrease {
    View<const Vec3> gradient;
    View<const PaddedVec3> direction;
    TOILE_HD double operator()(int i) const { return -gradient[i].dot(unpadded(direction[i])); }
};

/// Copies directions.
struct CopyDirection {
    View<const PaddedVec3> from;
    View<PaddedVec3> to;
    TOILE_HD void operator()(int i) const { to[i] = from[i]; }
};

/// Sums over the start of a step.
struct NewtonStartSums {
    static constexpr int kLargest = 0;

    double moving = 0.0;    ///< 1 if a fixed vertex has another target than its position
    double inertia = 0.0;   ///< [J] of no motion
    double driving = 0.0;   ///< [kg m^2] weight times the square of what external forces alone would move
    double stiffness = 0.0; ///< [N/m] of their inertia

    TOILE_HD NewtonStartSums& operator+=(const NewtonStartSums& other)
    {
        moving = std::fmax(moving, other.moving);
        inertia += other.inertia;
        driving += other.driving;
        stiffness += other.stiffness;
        return *this;
    }
};

struct MeasureNewtonStart {
    View<const Vec3> x, v, prediction;   ///< [vertices] at t0 [m], [m/s]; [m]
    View<const double> weights, inertia; ///< [vertices] [kg], [N/m]
    View<const unsigned char> fixed;     ///< [vertices]
    double dt;                           ///< [s]

    TOILE_HD NewtonStartSums operator()(int i) const
    {
        NewtonStartSums sums;
        const Vec3 move = prediction[i] - x[i];
        if (fixed[i] != 0) {
            sums.moving = move != Vec3(0.0, 0.0, 0.0) ? 1.0 : 0.0;
            return sums;
        }
        sums.inertia = 0.5 * inertia[i] * move.squaredNorm();
        sums.driving = weights[i] * (move - dt * v[i]).squaredNorm();
        sums.stiffness = inertia[i];
        return sums;
    }
};

/// Whether positions differ.
struct CountMoved {
    View<const Vec3> x, trial;
    TOILE_HD double operator()(int i) const { return x[i] != trial[i] ? 1.0 : 0.0; }
};

/// Start guess of a step: free vertices keep their velocity.
struct GuessByVelocity {
    View<const Vec3> x, v, prediction;
    View<const unsigned char> fixed;
    double dt;
    View<Vec3> guess;
    TOILE_HD void operator()(int i) const
    {
        guess[i] = fixed[i] != 0 ? Vec3(prediction[i]) : Vec3(x[i] + dt * v[i]);
    }
};

} // namespace toile
