#pragma once

#include <vector>

#include "core/pd/objective.h"

namespace toile {

/// Share of the tolerance [-] below which a last move is not worth looking where it leads.
inline constexpr double kNegligibleMove = 1e-4;

/// Descent that every method of the outer loop shares: a direction from the method, Armijo backtracking along
/// it [Nocedal & Wright 2006, alg. 3.1], and one rule for when to stop. The value never rises.
///
/// A method answers with the whole move that it wants, so that a step of one is the normal case and the
/// length of the direction tells how far x still is from where the method would rest.
class OuterLoop {
public:
    struct Settings {
        /// [m] Stop when no vertex would move further in an iteration and the objective agrees. That move is
        /// still made; it does not count as an iteration. Stop too where RecentValues::kWindow iterations
        /// together have gained less than what the objective says is negligible.
        double tolerance = 1e-5;
        int max_iterations = 50;
    };
    struct Outcome {
        int iterations = 0;
        int linear_iterations = 0; ///< PCG iterations of Newton's method; 0 for the others
        bool converged = false;
        double displacement = 0.0;  ///< [m] largest move of the last iteration
        double gradient_norm = 0.0; ///< [N] largest entry of the gradient at the end
        double value = 0.0;         ///< [J]; not finite when the start already was not
    };

    virtual ~OuterLoop() = default;

    /// Minimises from x, in place. Nothing is remembered from earlier calls.
    Outcome minimise(Objective& objective, View<Vec3> x, const Settings& settings);

protected:
    /// What a method sees of the loop.
    struct Here {
        View<const Vec3> x;        ///< [vertices] the current point [m]
        View<const Vec3> gradient; ///< [vertices] there [N]
        View<Vec3> scratch;        ///< [vertices] free until find_direction() returns
    };
    /// An accepted step.
    struct Step {
        double length = 0.0;           ///< [-] of the direction
        View<const Vec3> direction;    ///< [vertices] [m]
        View<const Vec3> gradient;     ///< [vertices] before [N]
        View<const Vec3> new_gradient; ///< [vertices] after [N]
    };

    OuterLoop() = default;
    OuterLoop(const OuterLoop&) = default;
    OuterLoop& operator=(const OuterLoop&) = default;
    OuterLoop(OuterLoop&&) = default;
    OuterLoop& operator=(OuterLoop&&) = default;

    /// Forgets earlier problems.
    virtual void begin(int vertex_count) = 0;

    /// The move that the method wants [m].
    virtual void find_direction(Objective& objective, const Here& here, View<Vec3> direction) = 0;

    /// Told of every accepted step.
    virtual void learn(const Step&) {}

    /// After a direction that does not lower the value: true when the method has dropped something and has
    /// another one to offer from the same point.
    virtual bool fall_back() { return false; }

    /// Step lengths to try before a direction is given up.
    virtual int max_trials() const;

    virtual int linear_iterations() const { return 0; } ///< since begin()

private:
    double line_search(Objective& objective, View<Vec3> x, double& value);

    std::vector<Vec3> gradient_, direction_, trial_, trial_gradient_;
};

} // namespace toile
