#pragma once

#include <cmath>

#include "core/pd/cuda/descent_kernels.h"
#include "core/pd/step/bdf2.h"
#include "core/pd/step/step_kernels.h"
#include "core/pd/step/step_tolerance.h"

namespace toile {

/// Sums over all vertices at the start of a step.
struct StepSums {
    double max_square = 0.0; ///< [m^2] of the predicted displacements: a maximum, not a sum
    double mass = 0.0;       ///< [kg] of the free vertices
    double driving = 0.0;    ///< StepError::Sums::driving
    double inertia = 0.0;    ///< [J] of no motion

    TOILE_HD StepSums& operator+=(const StepSums& other)
    {
        max_square = std::fmax(max_square, other.max_square);
        mass += other.mass;
        driving += other.driving;
        inertia += other.inertia;
        return *this;
    }
};

/// Writes the target of the k-th fixed vertex.
struct ScatterTarget {
    View<const int> fixed;    ///< vertices
    View<const Vec3> targets; ///< [fixed] [m]
    View<Vec3> to;            ///< [vertices] written where fixed [m]

    TOILE_HD void operator()(int k) const { to[fixed[k]] = targets[k]; }
};

/// Predicts vertex i.
struct BeginVertex {
    PredictMotion predict;
    View<Vec3> drive; ///< [vertices] out: y - x0 [m]

    TOILE_HD StepSums operator()(int i) const
    {
        predict(i);
        const Vec3 move = predict.prediction[i] - predict.motion.x[i];
        drive[i] = move;
        StepSums sums;
        sums.max_square = move.squaredNorm();
        if (predict.motion.fixed[i] != 0)
            return sums;
        sums.mass = predict.masses[i];
        sums.driving = sums.mass * sums.max_square;
        sums.inertia = 0.5 * predict.inertia[i] * sums.max_square;
        return sums;
    }
};

/// Writes the inputs of the step to the descent.
struct BeginDescent {
    View<Descent> descent; ///< [1]
    StepTolerance tolerance;
    StepStop stop;
    int max_iterations; ///< of a minimisation
    double dt;          ///< [s] Bdf2::implicit_step()

    TOILE_HD void operator()(const StepSums& sums) const
    {
        Descent& task = descent[0];
        task.tolerance = tolerance.of_step(std::sqrt(sums.max_square));
        task.stop = stop;
        task.max_iterations = max_iterations;
        task.dt2 = dt * dt;
        task.mass = sums.mass;
        task.driving = sums.driving;
        task.standing_inertia = sums.inertia;
        task.begin();
    }
};

/// Begins a descent's first trial at x [m].
struct BeginAt {
    View<const Vec3> x; ///< [vertices] [m]
    DescentFields fields;

    TOILE_HD void operator()(int i) const
    {
        fields.trial.x[i] = x[i];
        fields.begin_trial(i);
    }
};

/// Start guess without motion: x0, with fixed vertices at their targets.
struct StandStill {
    View<const Vec3> x, prediction;  ///< [vertices] [m]
    View<const unsigned char> fixed; ///< [vertices]
    View<Vec3> standing;             ///< [vertices] out [m]

    TOILE_HD void operator()(int i) const { standing[i] = fixed[i] ? prediction[i] : x[i]; }
};

/// Saves the result of a descent, or restores it: positions [m] and gradient [N], [vertices].
struct CopyFound {
    View<const Vec3> x, gradient;
    View<Vec3> to_x, to_gradient;

    TOILE_HD void operator()(int i) const
    {
        to_x[i] = x[i];
        to_gradient[i] = gradient[i];
    }
};

/// Restarts the descent within the same step.
struct BeginAgain {
    View<Descent> descent; ///< [1]
    double tolerance;      ///< [m]

    TOILE_HD void operator()(int) const
    {
        descent[0].tolerance = tolerance;
        descent[0].begin();
    }
};

/// Maximum over all vertices at the end of a step; NaN if any value is NaN.
struct LargestSquare {
    double value = 0.0;

    TOILE_HD LargestSquare& operator+=(const LargestSquare& other)
    {
        if (value < other.value || std::isnan(other.value))
            value = other.value;
        return *this;
    }
};

/// Sums over all vertices where the minimisation of a step has ended.
struct FinishSums {
    LargestSquare gradient; ///< [N^2] zero where fixed
    StepErrorSum error;

    TOILE_HD FinishSums& operator+=(const FinishSums& other)
    {
        gradient += other.gradient;
        error += other.error;
        return *this;
    }
};

/// Finishes the motion of vertex i at the minimiser, which is kept.
struct FinishVertex {
    FinishMotion finish;
    View<const Vec3> gradient; ///< [vertices] [N]
    View<Vec3> minimiser;      ///< [vertices] out [m]

    TOILE_HD FinishSums operator()(int i) const
    {
        const StepErrorSum error = finish(i);
        minimiser[i] = finish.x_t1[i];
        return {{finish.motion.fixed[i] != 0 ? 0.0 : gradient[i].squaredNorm()}, error};
    }
};

/// Ends the motion of vertex i and measures its speed.
struct EndVertex {
    EndMotion end;

    /// @return squared speed [m^2/s^2]
    TOILE_HD LargestSquare operator()(int i) const
    {
        end(i);
        return {end.motion.v[i].squaredNorm()};
    }
};

/// Adds the displacement by a constraint to the velocity.
struct AddProjected {
    View<const Vec3> before, x; ///< [vertices] [m]
    double dt;                  ///< [s]
    View<Vec3> v;               ///< [vertices] added to [m/s]

    TOILE_HD void operator()(int i) const { v[i] += (x[i] - before[i]) / dt; }
};

} // namespace toile
