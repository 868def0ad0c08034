#pragma once

#include "avatars/model/skeletal_motion.h"
#include "avatars/model/skinned_avatar.h"

namespace toile::avatars {

/// Clip of a body from one of a file of its own, by the names of the joints: rotations are those of the clip,
/// lengths are scaled as the bones of the body over those of the file, so units need not agree. The topmost
/// of these joints moves in the world as in its file, whatever is above it.
/// @throws InvalidInput for a body without bones, for a clip of which fewer than half of the joints are
/// joints
///         of the body, and for bones of other axes, which rotations can't be copied between
Clip copy_clip(const SkinnedAvatar& body, const SkeletalMotion& motion, const Clip& clip);

} // namespace toile::avatars
