#include "core/pd/minimiser/newton.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "core/base/error.h"
#include "core/pd/minimiser/line_search.h"

namespace toile {

namespace {

/// Conjugate gradients stop when the RMS of their increment is below this fraction of the tolerance [-],
/// twice in succession. With a fixed number of iterations several times the last step would remain.
constexpr double kIncrement = 0.1;

/// Iterations of a solve. One that ends here does not count as converged.
constexpr int kMaxLinearIterations = 60;

} // namespace

OuterLoop::Outcome Newton::minimise(Objective& objective, View<Vec3> x, const Settings& settings,
                                    const Revise& revise)
{
    const StageScope stage("pd/newton");
    for (std::vector<Vec3>* field : {&gradient_, &direction_, &trial_, &trial_gradient_})
        field->resize(x.size());
    OuterLoop::Outcome outcome;
    outcome.value = objective.evaluate(x, gradient_);
    while (std::isfinite(outcome.value) && outcome.iterations < settings.max_iterations) {
        objective.accept(x);
        Hessian* const K = objective.hessian();
        if (K == nullptr)
            throw InvalidInput("newton: the objective has no second derivatives; choose another method");
        K->linearise(x, Definiteness::Projected);
        precondition(*K);
        const Direction direction = find_direction(objective, *K, settings.tolerance);
        const double step = line_search(objective, x, outcome.value);
        ++outcome.iterations;
        outcome.linear_iterations += direction.linear_iterations;
        outcome.speed = direction.speed;
        outcome.displacement = step * max_norm(direction_);
        if (step > 0.0)
            gradient_.swap(trial_gradient_);
        outcome.converged = direction.is_solved && direction.speed <= settings.tolerance;
        const bool has_changed = revise && revise(outcome.converged);
        if (!has_changed && (outcome.converged || step == 0.0))
            break;
        outcome.converged = false;
        if (has_changed || step == 0.0)
            outcome.value = objective.evaluate(x, gradient_);
    }
    outcome.gradient_norm = max_norm(gradient_);
    return outcome;
}

void Newton::precondition(Hessian& K)
{
    const View<const Mat3> blocks = K.diagonal_blocks();
    inverse_blocks_.resize(blocks.size());
    parallel_for(kCpu, "newton/blocks", blocks.size(), [&](int i) {
        const Eigen::LLT<Mat3> factor(blocks[i]);
        inverse_blocks_[i] = factor.solve(Mat3::Identity());
    });
    if (!is_coarse_current_)
        coarse_.update(K.parts());
    is_coarse_current_ = true;
}

Newton::Direction Newton::find_direction(Objective& objective, Hessian& K, double tolerance)
{
    const StageScope stage("newton/pcg");
    Direction result;
    int small = 0;
    const auto multiply = [&](View<const Vec3> p, View<Vec3> out) { K.multiply(p, out); };
    const auto precondition = [&](View<const Vec3> r, View<Vec3> z) {
        parallel_for(
            kCpu, "newton/smooth", r.size(), [&](int i) { z[i] = inverse_blocks_[i] * r[i]; }, kFieldGrain);
        coarse_.correct(r, z);
    };
    const auto is_enough = [&](double step, View<const Vec3> p) {
        small = step * objective.speed_of(p) < kIncrement * tolerance ? small + 1 : 0;
        return small >= 2;
    };
    const Pcg::Outcome outcome =
        pcg_.solve(multiply, precondition, gradient_, direction_, {0.0, kMaxLinearIterations}, is_enough);
    for (Vec3& d : direction_)
        d = -d;
    result.linear_iterations = outcome.iterations;
    result.is_solved = outcome.iterations < kMaxLinearIterations || small >= 2;
    result.speed = objective.speed_of(direction_);
    return result;
}

/// Backtracks along the direction from x until the value decreases sufficiently; x and value move on success.
/// @return the accepted step length, 0 if there is none
double Newton::line_search(Objective& objective, View<Vec3> x, double& value)
{
    LineSearch search{value, dot(gradient_, direction_)};
    if (!(search.slope < 0.0))
        return 0.0;
    for (int attempt = 0; attempt < LineSearch::kMaxTrials; ++attempt) {
        parallel_for(
            kCpu, "newton/trial", x.size(), [&](int i) { trial_[i] = x[i] + search.step * direction_[i]; },
            kFieldGrain);
        const double trial_value = objective.evaluate(trial_, trial_gradient_);
        if (search.accepts(trial_value)) {
            std::copy(trial_.begin(), trial_.end(), x.begin());
            value = trial_value;
            return search.step;
        }
        search.shorten(trial_value);
    }
    return 0.0;
}

} // namespace toile
