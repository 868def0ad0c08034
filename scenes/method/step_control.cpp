#include "scenes/method/step_control.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"

namespace toile::scenes {

namespace {

/// Error of a step relative to the allowed one [-] that allows twice the length: the error of a step grows
/// with the third power of its length, and a margin keeps the two from alternating.
constexpr double kSmall = 0.1;

/// Shortest step [ticks], and error relative to the allowed one [-] from which on there are shorter ones:
/// cloth in a storm moves by whole edges in the shortest. Longer ones with that error are refused.
constexpr int kShortest = 4;
constexpr double kGross = 10.0;

/// Longest step over the first one [-], which is of first order.
constexpr int kFirst = 4;

} // namespace

StepControl StepControl::fixed(double sample_duration, int steps)
{
    return {sample_duration / steps, steps, 1, 1, 0.0};
}

StepControl StepControl::by_motion(double sample_duration, double error)
{
    TOILE_ASSERT(error > 0.0);
    const int longest_steps = std::max(1, int(std::ceil(sample_duration / kLongest - 1e-9)));
    const int ticks = longest_steps * kTicksOfLongest;
    return {sample_duration / ticks, ticks, kTicksOfLongest, kTicksOfLongest / kFirst, error};
}

double StepControl::shortest() const { return tick_ * (error_ > 0.0 ? kShortest : length_); }

int StepControl::choose(int begin, const std::function<double(int ticks)>& motion)
{
    if (error_ == 0.0)
        return 1;
    const int most = chosen_ == 0 ? length_ : std::min(length_, 2 * chosen_);
    chosen_ = most;
    while (begin % chosen_ != 0 || (chosen_ > kShortest && motion(chosen_) > 1.0))
        chosen_ /= 2;
    return chosen_;
}

double StepControl::max_error() const
{
    return error_ > 0.0 && chosen_ > kShortest ? kGross * error_ : kAnyStepError;
}

void StepControl::observe(const StepReport& step)
{
    if (error_ == 0.0)
        return;
    const int shortest = step.step_error > kGross * error_ ? 1 : std::min(kShortest, chosen_);
    if (step.step_error > error_)
        length_ = std::max(shortest, chosen_ / 2);
    else if (step.step_error < kSmall * error_)
        length_ = std::min(longest_, std::max(length_, 2 * chosen_));
}

} // namespace toile::scenes
