#include "scenes/meshes/rigid_motion.h"

#include <algorithm>
#include <numbers>
#include <utility>

namespace toile::scenes {

using scene::Keyframe;

namespace {

/// Rate of change at a keyframe of one coordinate [1/s].
/// @param before, after  slopes of the intervals on both sides, with their durations [s]
double rate_between(double before, double duration_before, double after, double duration_after)
{
    if (before * after <= 0.0)
        return 0.0;
    const double weight =
        (duration_before + 2.0 * duration_after) / (3.0 * (duration_before + duration_after));
    return before * after / (weight * after + (1.0 - weight) * before);
}

/// Rates of one vector of the keyframes, written to that of `rates`.
void find_rates(const std::vector<Keyframe>& keys, Vec3 Keyframe::*vector, std::vector<Keyframe>& rates)
{
    const int last = int(keys.size()) - 1;
    const auto duration = [&](int k) { return keys[k + 1].time - keys[k].time; };
    const auto slope = [&](int k) { return Vec3((keys[k + 1].*vector - keys[k].*vector) / duration(k)); };
    rates.front().*vector = slope(0);
    rates.back().*vector = slope(last - 1);
    for (int k = 1; k < last; ++k)
        for (int axis = 0; axis < 3; ++axis)
            (rates[k].*vector)[axis] =
                rate_between(slope(k - 1)[axis], duration(k - 1), slope(k)[axis], duration(k));
}

/// Cubic from a to b with these rates.
/// @param u  [-] in [0, 1]
Vec3 hermite(const Vec3& a, const Vec3& rate_a, const Vec3& b, const Vec3& rate_b, double duration, double u)
{
    const double v = 1.0 - u;
    return v * v * (1.0 + 2.0 * u) * a + u * u * (1.0 + 2.0 * v) * b +
           duration * u * v * (v * rate_a - u * rate_b);
}

} // namespace

Mat3 rotation_of(const Vec3& rotate_deg)
{
    const Vec3 angle = rotate_deg * (std::numbers::pi / 180.0);
    return (Eigen::AngleAxisd(angle.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(angle.y(), Vec3::UnitY()) *
            Eigen::AngleAxisd(angle.x(), Vec3::UnitX()))
        .toRotationMatrix();
}

RigidMotion::RigidMotion(std::vector<Keyframe> keyframes, const Vec3& pivot)
    : keyframes_(std::move(keyframes)), rates_(keyframes_.size()), pivot_(pivot)
{
    if (is_static())
        return;
    find_rates(keyframes_, &Keyframe::translate, rates_);
    find_rates(keyframes_, &Keyframe::rotate_deg, rates_);
}

Eigen::Isometry3d RigidMotion::at(double t) const
{
    Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();
    if (keyframes_.empty())
        return placement;

    const auto after =
        std::find_if(keyframes_.begin(), keyframes_.end(), [&](const Keyframe& key) { return key.time > t; });
    Keyframe key = after == keyframes_.begin() ? keyframes_.front() : *(after - 1);
    if (after != keyframes_.begin() && after != keyframes_.end()) {
        const double duration = after->time - key.time, u = (t - key.time) / duration;
        const Keyframe &rate = rates_[after - keyframes_.begin() - 1],
                       &rate_after = rates_[after - keyframes_.begin()];
        key.translate =
            hermite(key.translate, rate.translate, after->translate, rate_after.translate, duration, u);
        key.rotate_deg =
            hermite(key.rotate_deg, rate.rotate_deg, after->rotate_deg, rate_after.rotate_deg, duration, u);
    }
    placement.linear() = rotation_of(key.rotate_deg);
    placement.translation() = pivot_ + key.translate - placement.linear() * pivot_;
    return placement;
}

} // namespace toile::scenes
