#include "core/pd/minimiser/newton_pcg.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "core/base/error.h"
#include "core/linear/field.h"

namespace toile {

namespace {

/// Residual that CG may leave, relative to the gradient [-]: at first, and at least. A looser first step is
/// mistaken for convergence too early; a tighter one is wasted on a Hessian that will change.
constexpr double kMaxForcing = 0.5;
constexpr double kMinForcing = 1e-6;

/// Eisenstat and Walker's gamma, and the threshold of their safeguard against a fast decrease of the forcing
/// term.
constexpr double kGamma = 0.9;
constexpr double kSafeguard = 0.1;

/// Residual relative to the gradient [-] up to which a step counts as solved. CG's g . d grows towards
/// g . K^-1 g, so a loose solve would underestimate the remaining decrease.
constexpr double kAccurate = 0.01;

} // namespace

void NewtonPcg::begin(int vertex_count)
{
    linear_iterations_ = 0;
    previous_norm_ = 0.0;
    decrement_ = std::numeric_limits<double>::infinity();
    inverse_blocks_.resize(vertex_count);
}

void NewtonPcg::find_direction(Objective& objective, const Here& here, View<Vec3> direction)
{
    Hessian* const K = objective.hessian();
    if (K == nullptr)
        throw InvalidInput("newton-pcg: the objective has no second derivatives; choose another method");
    K->linearise(here.x, definiteness_);
    invert(K->diagonal_blocks());

    const auto multiply = [&](View<const Vec3> p, View<Vec3> out) { K->multiply(p, out); };
    const auto precondition = [&](View<const Vec3> r, View<Vec3> z) {
        objective.precondition_linearly(r, z);
        parallel_for(
            kCpu, "newton/blocks", r.size(), [&](int i) { z[i] += inverse_blocks_[i] * r[i]; }, kFieldGrain);
    };
    // Use flexible CG, for global solvers that are not symmetric.
    const Pcg::Settings settings{forcing_term(here.gradient), max_linear_iterations_, true};
    const Pcg::Outcome outcome = pcg_.solve(multiply, precondition, here.gradient, direction, settings);
    linear_iterations_ += outcome.iterations;
    if (outcome.residual <= kAccurate)
        decrement_ = dot(here.gradient, direction);
    if (max_norm(direction) == 0.0) // negative curvature in the first iteration
        precondition(here.gradient, direction);
    for (Vec3& d : direction)
        d = -d;
}

double NewtonPcg::forcing_term(View<const Vec3> gradient)
{
    const double norm = std::sqrt(dot(gradient, gradient));
    double forcing = kMaxForcing;
    if (previous_norm_ > 0.0) {
        const double ratio = norm / previous_norm_;
        const double kept = kGamma * previous_forcing_ * previous_forcing_;
        forcing = std::max(kGamma * ratio * ratio, kept > kSafeguard ? kept : 0.0);
        forcing = std::clamp(forcing, kMinForcing, kMaxForcing);
    }
    previous_norm_ = norm;
    previous_forcing_ = forcing;
    return forcing;
}

/// Inverts the blocks. A block with negative curvature is left to H^-1.
void NewtonPcg::invert(View<const Mat3> blocks)
{
    parallel_for(kCpu, "newton/invert", blocks.size(), [&](int i) {
        const Eigen::LLT<Mat3> factor(blocks[i]);
        if (factor.info() == Eigen::Success)
            inverse_blocks_[i] = factor.solve(Mat3::Identity());
        else
            inverse_blocks_[i].setZero();
    });
}

} // namespace toile
