#pragma once

#include <cmath>

#include "core/pd/device/descent_kernels.h"
#include "core/pd/step_kernels.h"
#include "core/pd/step_tolerance.h"

namespace toile {

/// What a step asks of all vertices before it begins.
struct StepSums {
    double farthest_square = 0.0; ///< [m^2] of the predicted moves: a maximum, not a sum
    double mass = 0.0;            ///< [kg] of the free vertices
    double driving = 0.0;         ///< StepError::Sums::driving

    TOILE_HD StepSums& operator+=(const StepSums& other)
    {
        farthest_square = std::fmax(farthest_square, other.farthest_square);
        mass += other.mass;
        driving += other.driving;
        return *this;
    }
};

/// Puts the k-th held vertex where it is to be.
struct PlaceTarget {
    View<const int> held;     ///< vertices
    View<const Vec3> targets; ///< [held] [m]
    View<Vec3> to;            ///< [vertices] written where held [m]

    TOILE_HD void operator()(int k) const { to[held[k]] = targets[k]; }
};

/// Predicts vertex i.
struct BeginVertex {
    PredictVertex predict;
    View<const double> masses; ///< [vertices] [kg]
    View<Vec3> drive;          ///< [vertices] out: q* - x0 [m]

    TOILE_HD StepSums operator()(int i) const
    {
        predict(i);
        const Vec3 move = predict.prediction[i] - predict.x[i];
        drive[i] = move;
        StepSums sums;
        sums.farthest_square = move.squaredNorm();
        if (predict.fixed[i])
            return sums;
        sums.mass = masses[i];
        sums.driving = sums.mass * sums.farthest_square;
        return sums;
    }
};

/// Tells the descent what is asked of it.
struct BeginDescent {
    View<Descent> descent; ///< [1]
    StepTolerance tolerance;
    StepStop stop;
    int max_iterations; ///< of a minimisation
    double dt;          ///< [s]

    TOILE_HD void operator()(const StepSums& sums) const
    {
        Descent& task = descent[0];
        task.tolerance = tolerance.of_step(std::sqrt(sums.farthest_square));
        task.stop = stop;
        task.max_iterations = max_iterations;
        task.dt2 = dt * dt;
        task.mass = sums.mass;
        task.driving = sums.driving;
        task.begin();
    }
};

/// Begins a descent's first trial where vertex i of x [m] is.
struct BeginAt {
    View<const Vec3> x; ///< [vertices] [m]
    DescentFields fields;

    TOILE_HD void operator()(int i) const
    {
        fields.trial.x[i] = x[i];
        fields.begin_trial(i);
    }
};

/// Where vertex i was at t0, and what is held where it belongs.
struct StandStill {
    View<const Vec3> x, prediction;  ///< [vertices] [m]
    View<const unsigned char> fixed; ///< [vertices]
    View<Vec3> standing;             ///< [vertices] out [m]

    TOILE_HD void operator()(int i) const { standing[i] = fixed[i] ? prediction[i] : x[i]; }
};

/// Copies positions.
struct CopyPositions {
    View<const Vec3> x;
    View<Vec3> to;
    TOILE_HD void operator()(int i) const { to[i] = x[i]; }
};

/// Keeps what a descent found, or brings it back: positions [m] and gradient [N], [vertices].
struct CopyFound {
    View<const Vec3> x, gradient;
    View<Vec3> to_x, to_gradient;

    TOILE_HD void operator()(int i) const
    {
        to_x[i] = x[i];
        to_gradient[i] = gradient[i];
    }
};

/// Begins the descent of the same step again.
struct BeginAgain {
    View<Descent> descent; ///< [1]
    double tolerance;      ///< [m]

    TOILE_HD void operator()(int) const
    {
        descent[0].tolerance = tolerance;
        descent[0].begin();
    }
};

/// What a step reports of all vertices: a largest value, which no NaN among them is lost to.
struct LargestSquare {
    double value = 0.0;

    TOILE_HD LargestSquare& operator+=(const LargestSquare& other)
    {
        if (value < other.value || std::isnan(other.value))
            value = other.value;
        return *this;
    }
};

/// The minimiser at vertex i becomes velocity.
struct FinishVertex {
    View<const Vec3> x, x_t1, gradient; ///< [vertices] at t0 and t1 [m], [N]
    double dt;                          ///< [s]
    View<Vec3> v;                       ///< [vertices] out [m/s]

    /// @return squared length of the gradient [N^2]
    TOILE_HD LargestSquare operator()(int i) const
    {
        v[i] = (x_t1[i] - x[i]) / dt;
        return {gradient[i].squaredNorm()};
    }
};

/// The end of the step at vertex i.
struct EndVertex {
    CopyPositions take;
    View<const Vec3> v; ///< [vertices] [m/s]

    /// @return squared speed [m^2/s^2]
    TOILE_HD LargestSquare operator()(int i) const
    {
        take(i);
        return {v[i].squaredNorm()};
    }
};

/// What a constraint has moved becomes velocity.
struct AddProjected {
    View<const Vec3> before, x; ///< [vertices] [m]
    double dt;                  ///< [s]
    View<Vec3> v;               ///< [vertices] added to [m/s]

    TOILE_HD void operator()(int i) const { v[i] += (x[i] - before[i]) / dt; }
};

} // namespace toile
