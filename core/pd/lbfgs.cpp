#include "core/pd/lbfgs.h"

#include <algorithm>
#include <cmath>
#include <iterator>

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
    TOILE_ASSERT(settings.history > 0);
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

/// direction = two-loop recursion applied to -gradient; each pass updates and takes the next product at once.
void Lbfgs::descend(Objective& objective)
{
    const int count = int(pairs_.size());
    alpha_.resize(count);
    std::vector<Vec3>& q = trial_gradient_;
    parallel_for(
        kCpu, "lbfgs/negate", int(q.size()), [&](int i) { q[i] = -gradient_[i]; }, kFieldGrain);
    double product = count > 0 ? dot(pairs_[count - 1].s, q) : 0.0;
    for (int i = count - 1; i >= 0; --i) {
        alpha_[i] = pairs_[i].rho * product;
        if (i > 0)
            product = axpy_dot(-alpha_[i], pairs_[i].y, q, pairs_[i - 1].s);
        else
            axpy(-alpha_[i], pairs_[i].y, q);
    }

    objective.precondition(q, direction_);
    product = count > 0 ? dot(pairs_[0].y, direction_) : 0.0;
    for (int i = 0; i < count; ++i) {
        const double factor = alpha_[i] - pairs_[i].rho * product;
        if (i + 1 < count)
            product = axpy_dot(factor, pairs_[i].s, direction_, pairs_[i + 1].y);
        else
            axpy(factor, pairs_[i].s, direction_);
    }
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
        parallel_for(
            kCpu, "lbfgs/trial", x.size(), [&](int i) { trial_[i] = x[i] + step * direction_[i]; },
            kFieldGrain);
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
    // s.y, s.s and y.y in one pass.
    const Vec3 products = parallel_sum(kCpu, n, Vec3(Vec3::Zero()), [&](int i) {
        pair.s[i] = step * direction_[i];
        pair.y[i] = trial_gradient_[i] - gradient_[i];
        return Vec3(pair.s[i].dot(pair.y[i]), pair.s[i].squaredNorm(), pair.y[i].squaredNorm());
    });
    gradient_.swap(trial_gradient_);

    const double curvature = products[0];
    const double scale = std::sqrt(products[1] * products[2]);
    if (curvature > kMinCurvature * scale) {
        pair.rho = 1.0 / curvature;
        pairs_.push_back(std::move(pair));
    } else {
        spare_.push_back(std::move(pair));
    }
}

} // namespace toile
