#pragma once

#include "avatars/mannequin/mannequin_shape.h"
#include "avatars/model/skinned_avatar.h"

namespace toile::avatars {

/// Joints of the mannequin, parents first; also their indices in its skeleton. Left is +X.
enum MannequinJoint {
    kPelvis,
    kSpine,
    kChest,
    kNeck,
    kHead,
    kUpperArmL,
    kLowerArmL,
    kHandL,
    kUpperArmR,
    kLowerArmR,
    kHandR,
    kThighL,
    kShinL,
    kFootL,
    kThighR,
    kShinR,
    kFootR,
    kMannequinJointCount
};

/// Skeleton of the mannequin. Joint frames are parallel to the world axes in the bind pose, so that clips can
/// refer to the X axis when they bend a knee.
Skeleton make_mannequin_skeleton(const MannequinShape& shape);

/// Binds the skin to the joints, one bone per joint. The distances to trunk and arm assign a vertex to one of
/// them; its position between the joints gives the weights along that part. Then weights diffuse over the
/// surface, never through the air. At most four bones per vertex.
SkinnedMesh bind_mannequin(const MannequinShape& shape, const Skeleton& skeleton, TriangleMesh mesh);

} // namespace toile::avatars
