#pragma once

#include "avatars/model/clip.h"

namespace toile::avatars {

/// Walk of the mannequin's skeleton (rig.h), at kMannequinHeight.
///
/// The hip, knee and ankle angles have the shape of unhurried human gait (a small knee bend under load, a
/// large one in swing). They are tuned by eye for flat feet on the floor, with the longer hip swing and the
/// narrow track of a runway. The pelvis is at the height where the lower foot just touches the floor.
/// @param arm_angle_deg  of the bind pose; in the walk the arms hang
/// @param period         [s] of two steps
/// @param cycles         1 in place, or the number of cycles to advance along +Z
Clip make_walk(const Skeleton& skeleton, double arm_angle_deg, double period, int cycles, bool advance);

/// One full rotation about the vertical in `duration` [s], with zero velocity at both ends, in the bind pose.
Clip make_turn(double duration);

} // namespace toile::avatars
