#include "core/pd/lbfgs.h"

#include <algorithm>
#include <cmath>

#include "core/linear/field.h"

namespace toile {

namespace {

/// Share of the predicted decrease that a step must reach [-] (Armijo).
constexpr double kSufficientDecrease = 1e-4;

/// Rounding noise of an objective value relative to its size [-]: differences below it prove nothing.
constexpr double kValueNoise = 1e-14;

/// Halvings (or stronger cuts) before a direction is given up.
constexpr int kMaxBacktracks = 12;

/// Pairs whose curvature s.y is below this share of |s||y| carry rounding, not curvature [-].
constexpr double kMinCurvature = 1e-10;

} // namespace

Lbfgs::Outcome Lbfgs::minimise(Objective& objective, View<Vec3> x, const Settings& settings)
{
    const int n = x.size();
    for (std::vector<Vec3>* field : {&gradient_, &direction_, &trial_, &trial_gradient_})
        field->resize(n);
    std::move(pairs_.begin(), pairs_.end(), std::back_inserter(spare_));
    pairs_.clear();

    Outcome outcome;
    outcome.value = objective.evaluate(x, gradient_);
    objective.accept(x);
    while (std::isfinite(outcome.value) && outcome.iterations < settings.max_iterations) {
        // Stop on a full quasi-Newton move that nobody would see: rest and free flight need none at all.
        descend(objective);
        outcome.displacement = max_norm(direction_);
        outcome.converged = outcome.displacement <= settings.tolerance;
        if (outcome.converged)
            break;

        const double step = line_search(objective, x, outcome.value);
        if (step == 0.0) {
            if (pairs_.empty())
                break;
            std::move(pairs_.begin(), pairs_.end(), std::back_inserter(spare_));
            pairs_.clear();
            continue;
        }
        ++outcome.iterations;
        outcome.displacement *= step;
        while (int(pairs_.size()) >= settings.history) {
            spare_.push_back(std::move(pairs_.front()));
            pairs_.erase(pairs_.begin());
        }
        remember(step);
        objective.accept(x);
    }
    outcome.gradient_norm = max_norm(gradient_);
    return outcome;
}

/// direction = -(two-loop recursion applied to the gradient)
void Lbfgs::descend(Objective& objective)
{
    const int count = int(pairs_.size());
    alpha_.resize(count);
    std::vector<Vec3>& q = trial_gradient_;
    q = gradient_;
    for (int i = count - 1; i >= 0; --i) {
        alpha_[i] = pairs_[i].rho * dot(pairs_[i].s, q);
        axpy(-alpha_[i], pairs_[i].y, q);
    }
    objective.precondition(q, direction_);
    for (int i = 0; i < count; ++i) {
        const double beta = pairs_[i].rho * dot(pairs_[i].y, direction_);
        axpy(alpha_[i] - beta, pairs_[i].s, direction_);
    }
    parallel_for(kCpu, "lbfgs/negate", int(direction_.size()),
                 [&](int i) { direction_[i] = -direction_[i]; });
}

/// Backtracks along the direction from x until the value decreases sufficiently; x and value move on success.
/// @return the accepted step length, 0 when there is none
double Lbfgs::line_search(Objective& objective, View<Vec3> x, double& value)
{
    const double slope = dot(gradient_, direction_);
    if (!(slope < 0.0))
        return 0.0;

    double step = 1.0;
    for (int attempt = 0; attempt < kMaxBacktracks; ++attempt) {
        parallel_for(kCpu, "lbfgs/trial", x.size(), [&](int i) { trial_[i] = x[i] + step * direction_[i]; });
        const double trial_value = objective.evaluate(trial_, trial_gradient_);
        if (trial_value <= value + kSufficientDecrease * step * slope + kValueNoise * std::abs(value)) {
            std::copy(trial_.begin(), trial_.end(), x.begin());
            value = trial_value;
            return step;
        }
        // Minimum of the parabola through value, slope and trial value, kept away from both ends.
        const double excess = trial_value - value - step * slope;
        const double parabola = std::isfinite(excess) ? -0.5 * slope * step * step / excess : 0.0;
        step = std::clamp(parabola, 0.1 * step, 0.5 * step);
    }
    return 0.0;
}

/// Keeps the accepted step and the change of the gradient, and moves on to the new gradient.
void Lbfgs::remember(double step)
{
    Pair pair;
    if (!spare_.empty()) {
        pair = std::move(spare_.back());
        spare_.pop_back();
    }
    const int n = int(gradient_.size());
    pair.s.resize(n);
    pair.y.resize(n);
    parallel_for(kCpu, "lbfgs/pair", n, [&](int i) {
        pair.s[i] = step * direction_[i];
        pair.y[i] = trial_gradient_[i] - gradient_[i];
    });
    gradient_.swap(trial_gradient_);

    const double curvature = dot(pair.s, pair.y);
    const double scale = std::sqrt(dot(pair.s, pair.s) * dot(pair.y, pair.y));
    if (curvature > kMinCurvature * scale) {
        pair.rho = 1.0 / curvature;
        pairs_.push_back(std::move(pair));
    } else {
        spare_.push_back(std::move(pair));
    }
}

} // namespace toile
