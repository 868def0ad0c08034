#include "avatars/skinned_avatar.h"

namespace toile {

namespace {

std::vector<Avatar::ClipName> clip_names(const std::vector<Clip>& clips)
{
    std::vector<Avatar::ClipName> names;
    names.reserve(clips.size());
    for (const Clip& clip : clips)
        names.push_back({clip.name, clip.duration});
    return names;
}

} // namespace

SkinnedAvatar::SkinnedAvatar(std::string source, RiggedModel model)
    : Avatar(std::move(source), model.mesh.rest.triangles, model.mesh.rest.vertex_count(),
             clip_names(model.clips)),
      model_(std::move(model)), local_(model_.skeleton.rest_pose()), frames_(model_.skeleton.size()),
      bones_(model_.mesh.bones.size())
{
    for (const Clip& clip : model_.clips)
        travel_of_clip_.push_back(root_travel(clip));
}

Vec3 SkinnedAvatar::root_travel(const Clip& clip) const
{
    // The root is the first joint in tree order that the clip translates at all.
    int root = -1;
    for (const JointTrack& track : clip.tracks) {
        const bool moves =
            track.translation.size() > 1 && track.translation.front().value != track.translation.back().value;
        if (moves && (root < 0 || track.joint < root))
            root = track.joint;
    }
    if (root < 0)
        return Vec3::Zero();

    std::vector<JointTransform> local(model_.skeleton.size());
    std::vector<Affine> frames(model_.skeleton.size());
    const auto root_at = [&](double time) {
        sample(clip, model_.skeleton, time, local);
        joint_frames(model_.skeleton, local, frames);
        return apply(model_.metres_from_file, frames[root].col(3));
    };
    Vec3 travel = root_at(clip.duration) - root_at(0.0);
    travel.y() = 0.0; // a figure that ends its clip crouching must not sink with every cycle
    return travel;
}

void SkinnedAvatar::pose(const PoseAt& at, const Affine& world_from_avatar, View<Vec3> out)
{
    // Joint transforms: the clip's, the bind pose's, or a blend.
    const bool clip_shows = at.clip >= 0 && at.bind_share < 1.0;
    if (clip_shows)
        sample(model_.clips[at.clip], model_.skeleton, at.time, local_);
    for (int j = 0; j < model_.skeleton.size(); ++j) {
        const JointTransform& rest = model_.skeleton.joints()[j].rest;
        if (!clip_shows)
            local_[j] = rest;
        else if (at.bind_share > 0.0)
            local_[j] = blend(local_[j], rest, at.bind_share);
    }

    // Frames in the world, then the surface.
    Affine world_from_file = compose(world_from_avatar, model_.metres_from_file);
    if (at.cycles != 0)
        world_from_file.col(3) +=
            world_from_avatar.leftCols<3>() * (double(at.cycles) * travel_of_clip_[at.clip]);
    joint_frames(model_.skeleton, local_, frames_);
    for (Affine& frame : frames_)
        frame = compose(world_from_file, frame);
    skin(model_.mesh, frames_, bones_, out);
}

} // namespace toile
