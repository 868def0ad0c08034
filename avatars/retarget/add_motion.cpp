#include "avatars/retarget/add_motion.h"

#include "avatars/import/model_builder.h"
#include "avatars/landmarks/body_joints.h"
#include "avatars/landmarks/skeleton_landmarks.h"
#include "avatars/model/skinned_avatar.h"
#include "avatars/retarget/cmu_skeleton.h"
#include "avatars/retarget/copy_clip.h"
#include "avatars/retarget/joint_map.h"
#include "avatars/retarget/motion_file.h"
#include "avatars/retarget/retarget.h"
#include "core/base/error.h"

namespace toile::avatars {

namespace {

Clip clip_for(SkinnedAvatar& body, const MotionSource& source)
{
    const SkeletalMotion motion = read_motion_file(source.file);
    const Clip& clip = clip_named(motion, source.clip);
    if (source.map == "names")
        return copy_clip(body, motion, clip);
    if (source.map == "cmu") {
        const JointMap map = map_from_cmu(body, motion);
        return retarget(body.model(), find_joints(body), motion, clip, map,
                        standing_pose(motion.skeleton, cmu_joints(motion.skeleton)));
    }
    const JointMap map = read_joint_map(source.map, body, motion);
    return retarget(body.model(), joints_by_name(body.model().skeleton), motion, clip, map,
                    rest_world_pose(motion.skeleton, identity_affine()));
}

void require_finite(const Clip& clip, const Skeleton& skeleton, const std::string& source)
{
    for (const JointTrack& track : clip.tracks) {
        const std::string place = source + ": clip '" + clip.name + "': joint '" +
                                  skeleton.joints()[size_t(track.joint)].name + "' of the body: ";
        require_usable(track.translation, place + "translation");
        require_usable(track.rotation, place + "rotation");
        require_usable(track.scale, place + "scale");
    }
}

} // namespace

std::string add_motion(Avatar& body, const MotionSource& source)
{
    auto* skinned = dynamic_cast<SkinnedAvatar*>(&body);
    if (skinned == nullptr || skinned->model().skeleton.size() == 0)
        throw InvalidInput(body.source() + ": has no bones, so " + source.file.string() +
                           " can't move it; use a .glb, .gltf or .fbx body with bones");
    Clip clip = clip_for(*skinned, source);
    require_finite(clip, skinned->model().skeleton, source.file.string());
    return skinned->add_clip(std::move(clip));
}

} // namespace toile::avatars
