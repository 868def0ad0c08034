#include "avatars/model/motion.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace toile::avatars {

namespace {

void require_not_negative(double value, const std::string& setting, const Avatar& avatar)
{
    if (!(value >= 0.0) || !std::isfinite(value))
        throw InvalidInput(avatar.source() + ": motion " + setting + " = " + std::to_string(value) +
                           " must be a finite number, 0 or more");
}

double smoothstep(double u) { return u * u * (3.0 - 2.0 * u); }

/// Clip time elapsed `s` seconds after the ramp began [s].
double ramped_time(double s, double ease, double speed)
{
    if (s <= 0.0)
        return 0.0;
    if (s >= ease)
        return speed * (s - 0.5 * ease);
    const double u = s / ease;
    return speed * ease * (u * u * u - 0.5 * u * u * u * u);
}

} // namespace

void require_usable(const Motion& motion, const Avatar& avatar)
{
    require_not_negative(motion.speed, "speed", avatar);
    require_not_negative(motion.start, "start", avatar);
    require_not_negative(motion.pre_roll.hold, "pre_roll.hold", avatar);
    require_not_negative(motion.pre_roll.ease, "pre_roll.ease", avatar);
    if (motion.clip.empty())
        return;
    const double duration = avatar.clips()[avatar.clip_index(motion.clip)].duration;
    if (motion.start > duration)
        throw InvalidInput(avatar.source() + ": motion start = " + std::to_string(motion.start) +
                           " s is after the end of clip '" + motion.clip + "' (" + std::to_string(duration) +
                           " s)");
    if (motion.loop && !(duration > 0.0))
        throw InvalidInput(avatar.source() + ": clip '" + motion.clip +
                           "' lasts 0 s and can't loop; turn loop off");
}

PoseAt pose_at(const Motion& motion, int clip, double clip_duration, double t)
{
    PoseAt at;
    at.clip = clip;
    if (clip < 0)
        return at;

    // Weight of the bind pose: 1 while holding, then decreasing to 0.
    const PreRoll& pre_roll = motion.pre_roll;
    double since_ramp = std::max(t, 0.0) - pre_roll.hold;
    if (pre_roll.from_bind) {
        if (since_ramp < pre_roll.ease)
            at.bind_weight = since_ramp <= 0.0 ? 1.0 : 1.0 - smoothstep(since_ramp / pre_roll.ease);
        since_ramp -= pre_roll.ease;
    }

    // Compute the clip time, wrapped or clamped at the end.
    at.time = motion.start + ramped_time(since_ramp, pre_roll.ease, motion.speed);
    if (!motion.loop) {
        at.time = std::min(at.time, clip_duration);
        return at;
    }
    const double cycles = std::floor(at.time / clip_duration);
    at.time = std::clamp(at.time - cycles * clip_duration, 0.0, clip_duration);
    at.cycles = motion.accumulate_root ? int(cycles) : 0;
    return at;
}

double blend_duration(Avatar& avatar, const Motion& motion, double max_speed)
{
    constexpr int kIntervals = 64;
    Motion blend = motion;
    blend.pre_roll = {.hold = 0.0, .ease = 1.0, .from_bind = true};
    const int clip = avatar.clip_index(motion.clip);
    const auto pose = [&](int interval, std::vector<Vec3>& x) {
        const double u = double(interval) / kIntervals;
        avatar.pose(pose_at(blend, clip, avatar.clips()[size_t(clip)].duration, u), identity_affine(), x);
    };

    std::vector<Vec3> x(size_t(avatar.vertex_count())), next(x.size());
    pose(0, x);
    double largest = 0.0;
    for (int interval = 1; interval <= kIntervals; ++interval) {
        pose(interval, next);
        for (size_t v = 0; v < x.size(); ++v)
            largest = std::max(largest, (next[v] - x[v]).norm());
        x.swap(next);
    }
    return kIntervals * largest / max_speed;
}

double end_time(const Motion& motion, double clip_duration)
{
    const PreRoll& pre_roll = motion.pre_roll;
    const double ease = pre_roll.ease, ramp_begin = pre_roll.hold + (pre_roll.from_bind ? ease : 0.0);
    const double left = std::max(0.0, clip_duration - motion.start);
    const double shown = ramped_time(ease, ease, motion.speed);
    if (left >= shown)
        return ramp_begin + ease + (left - shown) / motion.speed;
    double early = 0.0, late = ease; // within the ramp, which never turns back
    for (int halving = 0; halving < 60; ++halving) {
        const double middle = 0.5 * (early + late);
        (ramped_time(middle, ease, motion.speed) < left ? early : late) = middle;
    }
    return ramp_begin + late;
}

bool shows_one_pose(const Motion& motion)
{
    return motion.clip.empty() || (motion.speed == 0.0 && !motion.pre_roll.from_bind);
}

} // namespace toile::avatars
