#include "core/pd/step_error.h"

#include <cmath>

#include "core/backend/parallel.h"

namespace toile {

namespace {

/// Share [-] of what drives a step, M (q* - x0) / dt^2, that may be left in the gradient.
constexpr double kMostUnanswered = 0.3;

} // namespace

struct StepError::Sums {
    double mass = 0.0;
    double move = 0.0;     ///< |move|^2_M
    double force = 0.0;    ///< |M^-1 g|^2_M
    double driving = 0.0;  ///< |q* - x0|^2_M
    double opposing = 0.0; ///< g . (q* - x0)

    Sums& operator+=(const Sums& other)
    {
        mass += other.mass;
        move += other.move;
        force += other.force;
        driving += other.driving;
        opposing += other.opposing;
        return *this;
    }
};

StepError::StepError(View<const double> masses, View<const unsigned char> fixed, View<const Vec3> start,
                     View<const Vec3> prediction, double dt)
    : masses_(masses), fixed_(fixed), start_(start), prediction_(prediction), dt2_(dt * dt)
{
}

bool StepError::is_within(double tolerance, View<const Vec3> gradient, View<const Vec3> move) const
{
    const Sums all = sums(gradient, move);
    const double least = std::sqrt(all.move), most = dt2_ * std::sqrt(all.force);
    return least * most <= tolerance * tolerance * all.mass &&
           dt2_ * std::abs(all.opposing) <= kMostUnanswered * all.driving;
}

StepError::Sums StepError::sums(View<const Vec3> gradient, View<const Vec3> move) const
{
    return parallel_sum(kCpu, gradient.size(), Sums{}, [&](int i) {
        Sums term;
        if (fixed_[i])
            return term;
        const Vec3 drive = prediction_[i] - start_[i];
        term.mass = masses_[i];
        term.move = masses_[i] * move[i].squaredNorm();
        term.force = gradient[i].squaredNorm() / masses_[i];
        term.driving = masses_[i] * drive.squaredNorm();
        term.opposing = gradient[i].dot(drive);
        return term;
    });
}

} // namespace toile
