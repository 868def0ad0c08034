#pragma once

#include "avatars/mannequin/figure.h"
#include "avatars/skinned_avatar.h"

namespace toile {

/// The mannequin's joints, parents first; also their indices in its skeleton. Left is +X.
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

/// Joint frames are parallel to the world axes in the bind pose, so that clips can speak of the X axis when
/// they bend a knee.
Skeleton make_mannequin_skeleton(const Figure& figure);

/// Ties the skin to the joints, one bone per joint. A vertex belongs to trunk or arm by the distances of
/// those parts, along a part by its place between the joints; then weights diffuse over the surface, never
/// through the air. At most four bones a vertex.
SkinnedMesh bind_mannequin(const Figure& figure, const Skeleton& skeleton, TriangleMesh mesh);

} // namespace toile
