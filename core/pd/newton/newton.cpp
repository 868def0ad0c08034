#include "core/pd/newton/newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/long_work.h"
#include "core/base/stages.h"
#include "core/pd/minimiser/line_search.h"

namespace toile {

namespace {

/// Error of a direction that is small enough, relative to the tolerance [-].
constexpr double kDirectionError = 0.3;

/// Newton step, relative to the tolerance [-], from which on the minimum is near.
constexpr double kNear = 10.0;

/// Bound on the Newton step, relative to the tolerance [-], below which no step is made. A larger step
/// is made although it is small: unbalanced forces that no step follows would never come to balance.
constexpr double kNegligible = 0.03;

/// Largest estimate of the number of steps to the minimum [-]. A step below kNegligible of the tolerance has
/// converged whatever the estimate.
constexpr double kMaxSteps = 1.0 / kNegligible;

/// Iterations without a lower value after which the minimisation ends. Cloth that is moved back because it
/// would cross, where contact does not hold it, is pushed there again by the next step. If moving it back
/// undoes what steps gain, as where a body pulls it through other cloth, the minimisation ends after a few
/// such setbacks. The result of one that ends unfinished is the point with the lowest value since the
/// objective last changed.
constexpr int kStall = 8;

/// A step that contact has moved back may end above its start by a part kRaise of what it had gained [-]. One
/// that ends higher is made again, kShorter as long [-], up to kRetakes times: where parts of a body are
/// stopped while the rest of it goes on, its elements are crushed, and directions from there lead nowhere.
constexpr double kRaise = 0.25, kShorter = 0.4;
constexpr int kRetakes = 4;

/// Part of its gain [-] below which a step that was moved back is a setback.
constexpr double kKept = 0.1;

/// Tolerance of touching cloth [m/s] by the speed that external forces add in a step. In small steps that is
/// below any fixed tolerance: cloth that should begin to slide would stay where it is, step after step. The
/// error of its acceleration is at most about kOfDriving, and vanishes with the step below kDrivingOfStep,
/// gravity's speed in 1/120 s. Rounding leaves no less than kReachable [m/s] to be found.
constexpr double kOfDriving = 0.15, kDrivingOfStep = 0.04, kReachable = 1e-6;

/// Small Newton steps in succession after which touching cloth has converged. The first leaves contact forces
/// unbalanced by 14 % of the weight, which moves cloth by next to nothing, but friction by as much.
constexpr int kSmallSteps = 2;

/// Small Newton steps in succession after which cloth has converged although each look has found other pairs.
/// Where surfaces slide on fine triangles, some of their vertices meet other triangles in every iteration.
constexpr int kSettled = 4;

/// @param driving  speed that external forces add in the step [m/s]
double tolerance_by_driving(double driving)
{
    return std::max(kReachable, kOfDriving * driving * std::min(1.0, driving / kDrivingOfStep));
}

/// Corrections of a direction by the contact ahead. Most need one or two.
constexpr int kContactCorrections = 4;

/// Part of its predicted decrease [-] that a model must reach to be trusted, and the factor by which its
/// direction is shortened otherwise, at most kMaxShortenings times.
constexpr double kTrusted = 0.7, kShorten = 0.3;
constexpr int kMaxShortenings = 7;

/// Rounding error of the model relative to the objective's value [-].
constexpr double kModelNoise = 1e-12;

/// Chooses the start. @return its value
double begin(NewtonSpace& space, bool tries_local_global)
{
    const double value = space.evaluate();
    if (const double at_rest = space.try_rest(value); at_rest < value) {
        space.take();
        return at_rest;
    }
    if (!tries_local_global || space.are_fixed_moving())
        return value;
    // H does not contain internal friction and may leave bending out.
    const double moved = space.try_local_global();
    if (!(moved < value))
        return value;
    space.take();
    return moved;
}

/// Finds a direction that sees the contact ahead. K knows what presses now; along its direction cloth meets
/// what does not press yet, a thousand times stiffer than what moves it, and a line search would allow a
/// hundredth of the step. So contact is linearised anew where the direction leads, as far as the model's
/// value falls, and the direction is corrected: a semi-smooth Newton method on the model [Hintermueller et
/// al. 2002]. It ends with a correction as small as the error, which then counts as error: pairs that come
/// and go would be corrected forever.
/// @param value  of the objective [J]
/// @return not solved if the direction is not the model's minimum
NewtonSpace::Solution find_corrected_direction(NewtonSpace& space, bool is_first, double error, double value)
{
    NewtonSpace::Solution found = space.find_direction(is_first, error);
    if (!space.has_contact())
        return found;
    const double noise = kModelNoise * std::fabs(value);
    double reached = 0.0, predicted = found.decrease;
    for (int correction = 0;; ++correction) {
        double length = 1.0, now = space.model(length);
        if (reached - now >= kTrusted * predicted - noise)
            return found;
        for (int k = 0;
             k < kMaxShortenings && !(now <= reached - LineSearch::kSufficientDecrease * length * predicted);
             ++k)
            now = space.model(length *= kShorten);
        const bool falls = now < reached, is_small = found.size <= error;
        if (!falls)
            space.model(correction == 0 ? 1.0 : 0.0); // the line search has more trials
        if (is_small)
            found.error = std::hypot(found.error, found.size);
        else
            found.is_solved = false;
        if (is_small || !falls || correction == kContactCorrections)
            return found;
        reached = now;
        const NewtonSpace::Solution more = space.correct(error);
        predicted = more.decrease;
        found.iterations += more.iterations;
        found.is_solved = more.is_solved;
        found.error = more.error;
        found.size = more.size;
    }
}

MinimiserProgress progress_of(const OuterLoop::Outcome& outcome, double tolerance, bool has_settled)
{
    if (outcome.converged)
        return has_settled ? MinimiserProgress::kSettled : MinimiserProgress::kConverged;
    return outcome.speed < kNear * tolerance ? MinimiserProgress::kNear : MinimiserProgress::kFar;
}

/// Estimate of the distance to the minimum along a direction of which `step` was accepted, at least the whole
/// direction [-]. K is projected: where it is stiffer than the objective, as in elements that are inside out,
/// steps are short though the minimum is far.
double steps_to_minimum(const NewtonSpace::Trial& trial, double step)
{
    if (step == 0.0)
        return 1.0; // rounding hides the rest
    const double curvature = (trial.end_slope - trial.slope) / step;
    return curvature > 0.0 ? std::clamp(-trial.slope / curvature, 1.0, kMaxSteps) : kMaxSteps;
}

/// Makes a Newton step.
/// @param reach  [m] displacement at which the line search begins at most
/// @return the accepted part of it, 0 if there is none
double iterate(NewtonSpace& space, const Newton::Settings& settings, double reach,
               OuterLoop::Outcome& outcome)
{
    const NewtonSpace::Solution direction = find_corrected_direction(
        space, outcome.iterations == 0, kDirectionError * settings.tolerance, outcome.value);
    NewtonSpace::Trial trial = space.try_step(1.0);
    LineSearch search{outcome.value, trial.slope};
    if (trial.displacement > reach)
        trial = space.try_step(search.step = reach / trial.displacement);
    double step = 0.0;
    for (int attempt = 1; search.slope < 0.0; ++attempt) {
        if (search.accepts(trial.value)) {
            space.take();
            outcome.value = trial.value;
            step = search.step;
            break;
        }
        if (attempt == LineSearch::kMaxTrials)
            break;
        search.shorten(trial.value);
        trial = space.try_step(search.step);
    }
    ++outcome.iterations;
    outcome.linear_iterations += direction.iterations;
    outcome.speed = trial.speed;
    outcome.displacement = step * trial.displacement;
    outcome.converged =
        direction.is_solved &&
        steps_to_minimum(trial, step) * std::hypot(trial.speed, direction.error) <= settings.tolerance;
    return step;
}

/// Makes a step that contact has moved back to too high a value again, shorter.
/// @param start, gain  value before the step, and what it gained without contact [J]
/// @param step         its length [-]
/// @param reach        [m] becomes the displacement of the best one, if it ends lower than what was moved
/// back
/// @return true if it was made again; the last one is the result
bool retake(NewtonSpace& space, const Newton::Revise& revise, double start, double gain, double step,
            double& reach, OuterLoop::Outcome& outcome)
{
    const double of_direction = outcome.displacement / step; // [m]
    bool falls = true, has_moved = true;
    int retakes = 0;
    for (; falls && has_moved && retakes < kRetakes && outcome.value > start + kRaise * gain; ++retakes) {
        const double before = outcome.value;
        step *= kShorter;
        space.retake(step);
        revise(MinimiserProgress::kFar);
        has_moved = space.has_moved();
        outcome.value = space.evaluate();
        outcome.displacement = step * of_direction;
        falls = outcome.value < before;
        if (falls)
            reach = outcome.displacement;
    }
    return retakes > 0;
}

} // namespace

OuterLoop::Outcome Newton::minimise(NewtonSpace& space, const Settings& of_scene, const Revise& revise,
                                    bool is_calm)
{
    const StageScope stage("pd/newton");
    OuterLoop::Outcome outcome;
    outcome.value = begin(space, is_calm && of_scene.begins_by_local_global);
    Settings settings = of_scene;
    if (!is_calm)
        settings.tolerance = std::min(settings.tolerance, tolerance_by_driving(space.driving_speed()));
    const int small_steps = is_calm ? 1 : kSmallSteps;
    double lowest = std::numeric_limits<double>::infinity(), kept_value = lowest;
    double reach = lowest;
    int since_lowest = 0, small = 0, small_with_any_pairs = 0, setbacks = 0;
    for (int look = 0; std::isfinite(outcome.value) && look < settings.max_iterations; ++look) {
        LongWork::iterate(look + 1);
        since_lowest = outcome.value < lowest ? 0 : since_lowest + 1;
        lowest = std::min(lowest, outcome.value);
        if (look > 0 && outcome.value < kept_value) {
            space.keep();
            kept_value = outcome.value;
        }
        if (since_lowest > kStall || setbacks > settings.max_setbacks)
            break;

        const double start = outcome.value;
        double step = 0.0;
        outcome.speed = space.max_speed();
        outcome.converged = outcome.speed <= kNegligible * settings.tolerance;
        if (!outcome.converged) {
            step = iterate(space, settings, reach, outcome);
            small = outcome.converged ? small + 1 : 0;
            small_with_any_pairs = outcome.converged ? small_with_any_pairs + 1 : 0;
            outcome.converged = outcome.converged &&
                                (small >= small_steps || step == 0.0 || small_with_any_pairs >= kSettled);
        }
        const bool has_settled = small_with_any_pairs >= kSettled;
        const bool has_changed = revise && revise(progress_of(outcome, settings.tolerance, has_settled));
        if (!has_changed && (outcome.converged || step == 0.0))
            break;
        outcome.converged = false;
        if (has_changed) {
            lowest = kept_value = std::numeric_limits<double>::infinity();
            small = 0;
        }
        // Cloth may have been moved back by less than counts as a change: stiff terms feel that too.
        const bool has_moved = step > 0.0 && space.has_moved();
        if (!has_moved)
            reach *= 2.0;
        if (!has_changed && !has_moved && step > 0.0)
            continue;
        const double gain = start - outcome.value;
        outcome.value = space.evaluate();
        if (!has_moved)
            continue;
        if (retake(space, revise, start, gain, step, reach, outcome))
            small = small_with_any_pairs = 0;
        setbacks += start - outcome.value < kKept * gain ? 1 : 0;
    }
    if (!outcome.converged && kept_value < outcome.value) {
        space.restore();
        outcome.value = space.evaluate();
    }
    outcome.gradient_norm = space.gradient_norm();
    return outcome;
}

} // namespace toile
