#include "core/pd/step/step_error.h"

#include "core/compute/parallel.h"

namespace toile {

StepError::StepError(View<const double> masses, View<const unsigned char> fixed, View<const Vec3> start,
                     View<const Vec3> prediction, double dt)
    : masses_(masses), fixed_(fixed), start_(start), prediction_(prediction), dt2_(dt * dt)
{
}

bool StepError::is_within(double tolerance, View<const Vec3> gradient, View<const Vec3> move,
                          StepStop stop) const
{
    return sums(gradient, move).are_within(tolerance, dt2_, stop);
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
