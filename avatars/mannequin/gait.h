#pragma once

#include "avatars/clip.h"

namespace toile {

/// Motions of the mannequin's skeleton (rig.h), at kFigureHeight.
///
/// The walk's hip, knee and ankle angles have the shape of unhurried human gait (a small knee bend under
/// load, a large one in swing), tuned by eye for flat feet on the floor, with the longer hip swing and the
/// narrow track of a runway. The pelvis rides at the height where the lower foot just touches the floor.
/// @param arm_angle_deg  of the bind pose; the walk lets the arms hang
/// @param period         [s] of two steps
/// @param cycles         1 in place, or the number of cycles to advance along +Z
Clip make_walk(const Skeleton& skeleton, double arm_angle_deg, double period, int cycles, bool advance);

/// One full turn about the vertical in `duration` [s], starting and ending at rest, standing as in the bind
/// pose.
Clip make_turn(double duration);

} // namespace toile
