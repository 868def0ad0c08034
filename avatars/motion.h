#pragma once

#include <string>

#include "avatars/avatar.h"

namespace toile {

/// How a motion begins. A garment is draped before its wearer moves, and a body that jumps to full speed
/// tears at it.
///
///   clip time
///     |                          ____/    slope = speed
///     |   hold     ease     ease/
///     |----------|~~~~~~~~|---´
///     +----------+--------+------+----->  simulation time
///       bind pose  blend    time ramp     (from_bind; without it the clip's pose is held, no blend)
struct PreRoll {
    double hold = 0.0;      ///< [s] standing still
    double ease = 0.0;      ///< [s] of the blend and of the time ramp, each
    bool from_bind = false; ///< stand in the bind pose and blend into the clip's pose at `start`
};

/// Which clip to play, and how.
struct Motion {
    std::string clip;             ///< empty: the bind pose, for ever
    bool loop = false;            ///< begin again at the end; without it the last pose is held
    double speed = 1.0;           ///< [-] clip seconds per simulation second; 0 freezes the pose at `start`
    double start = 0.0;           ///< [s] of the clip
    bool accumulate_root = false; ///< a looping walk goes on from where it is instead of jumping back
    PreRoll pre_roll;
};

/// @throws InvalidInput naming `source`, the setting, its value and its range: times and speed must be finite
///         and not negative, `start` not after the clip's end, a looping clip longer than 0 s.
void require_usable(const Motion& motion, const Avatar& avatar);

/// What to show at simulation time t [s]; t < 0 counts as 0.
///
/// Clip time during the ramp, with u = s / ease:  start + speed ease (u^3 - u^4 / 2)
/// is the integral of speed (3 u^2 - 2 u^3): position, velocity and acceleration are continuous at both ends.
PoseAt pose_at(const Motion& motion, int clip, double clip_duration, double t);

/// True when no two times show different poses.
bool shows_one_pose(const Motion& motion);

} // namespace toile
