#pragma once

#include <string>

#include "avatars/model/avatar.h"

namespace toile::avatars {

/// Start of a motion. A garment is draped before its wearer moves, and sudden full speed would pull hard on
/// it.
///
///   clip time
///     |                          ____/    slope = speed
///     |   hold     ease     ease/
///     |----------|~~~~~~~~|---´
///     +----------+--------+------+----->  simulation time
///       bind pose  blend    time ramp     (from_bind; without it the clip's pose is held, no blend)
struct PreRoll {
    double hold = 0.0;      ///< [s] without motion
    double ease = 0.0;      ///< [s] duration of the blend and of the time ramp, each
    bool from_bind = false; ///< hold the bind pose and blend into the clip's pose at `start`
};

/// Clip to play, with its timing.
struct Motion {
    std::string clip;             ///< empty: the bind pose throughout
    bool loop = false;            ///< repeat the clip; otherwise the last pose is held
    double speed = 1.0;           ///< [-] clip seconds per simulation second; 0 freezes the pose at `start`
    double start = 0.0;           ///< [s] of the clip
    bool accumulate_root = false; ///< a looping walk continues from its position instead of jumping back
    PreRoll pre_roll;
};

/// @throws InvalidInput naming `source`, the setting, its value and its range: times and speed must be finite
///         and not negative, `start` not after the clip's end, a looping clip longer than 0 s.
void require_usable(const Motion& motion, const Avatar& avatar);

/// Pose at simulation time t [s]; t < 0 counts as 0.
///
/// Clip time during the ramp, with u = s / ease:  start + speed ease (u^3 - u^4 / 2)
/// is the integral of speed (3 u^2 - 2 u^3): position, velocity and acceleration are continuous at both ends.
PoseAt pose_at(const Motion& motion, int clip, double clip_duration, double t);

/// Shortest PreRoll::ease [s] for which the blend from the bind pose to the clip's pose at `start` moves no
/// vertex of the skin faster than max_speed [m/s]; 0 if they are one pose. The fastest of a blend that lasts
/// T has max |dx/du| / T, with u = t / T. It is measured by differences over 1/64 of the blend, to 0.1 %.
double blend_duration(Avatar& avatar, const Motion& motion, double max_speed);

/// Simulation time [s] from which on a motion that does not loop holds the last pose of its clip, or the end
/// of the time ramp if it does so earlier. @param motion  of a positive speed
double end_time(const Motion& motion, double clip_duration);

/// True if the pose is the same at all times.
bool shows_one_pose(const Motion& motion);

} // namespace toile::avatars
