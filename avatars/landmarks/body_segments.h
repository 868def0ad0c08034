#pragma once

#include <array>

#include "avatars/landmarks/body_landmarks.h"
#include "avatars/model/avatar.h"
#include "core/mesh/axis_segment.h"

namespace toile::avatars {

/// Parts of the body that clothes are laid around. Also indices into BodySegments.
enum class BodyPart { Torso, Neck, LeftArm, RightArm, LeftLeg, RightLeg };

/// Segments of a body, by BodyPart, in one pose:
///
///   torso  from the crotch to the collarbones; its skin goes on along the thighs, without arms
///   neck   from the collarbones to the head
///   arms   from the wrist to the shoulder
///   legs   from the ankle to the level of the crotch
///
/// Their fronts are those of a body that stands with hanging arms, rotated along with the axis by the
/// shortest rotation: the front of an arm in T-pose is that of the body, and 90 degrees are above a left arm.
using BodySegments = std::array<AxisSegment, 6>;

/// Body in one pose: where clothes are laid around it.
struct BodyArrangement {
    BodyLandmarks landmarks;
    BodySegments segments;
};

/// Finds landmarks and segments of a body in a pose. A body with bones has them from its skeleton (joints by
/// name, or by the tree where names say nothing) and from the skin that follows each joint; one without bones
/// from slices, which is possible in A- and T-pose: find_upright_body().
/// @param given  replace those found; in the pose [m]
/// @throws InvalidInput in one line that names the first part that can't be found
BodyArrangement find_segments(Avatar& avatar, const PoseAt& at, const Affine& world_from_avatar,
                              const GivenLandmarks& given = {});

/// The same from slices also where there are bones: the pose must be an A- or T-pose.
BodyArrangement find_segments_by_slices(Avatar& avatar, const PoseAt& at, const Affine& world_from_avatar,
                                        const GivenLandmarks& given = {});

} // namespace toile::avatars
