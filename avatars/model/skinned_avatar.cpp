#include "avatars/model/skinned_avatar.h"

#include <algorithm>

#include "core/base/error.h"

namespace toile::avatars {

namespace {

std::vector<Avatar::ClipName> clip_names(const std::vector<Clip>& clips)
{
    std::vector<Avatar::ClipName> names;
    names.reserve(clips.size());
    for (const Clip& clip : clips)
        names.push_back({clip.name, clip.duration});
    return names;
}

/// "the nearest are 'a', 'b'", or all existing names if none is near.
std::string suggestion(const std::string& name, const std::vector<std::string>& names)
{
    constexpr size_t kSuggestions = 3;
    std::vector<std::string> others = names, near;
    while (near.size() < kSuggestions) {
        const std::string next = nearest_word(name, others);
        if (next.empty())
            break;
        near.push_back(next);
        std::erase(others, next);
    }
    std::string list;
    for (const std::string& known : near.empty() ? names : near)
        list += (list.empty() ? "'" : ", '") + known + "'";
    return (near.empty() ? "it has " : near.size() == 1 ? "the nearest is " : "the nearest are ") + list;
}

/// Joint of that name.
int require_bone(const Skeleton& skeleton, const std::string& name, const std::string& source,
                 const std::string& user)
{
    if (const int joint = skeleton.find(name); joint >= 0)
        return joint;
    std::vector<std::string> names;
    for (const Joint& joint : skeleton.joints())
        names.push_back(joint.name);
    throw InvalidInput(user + ": " + source + " has no bone '" + name + "'; " + suggestion(name, names));
}

[[noreturn]] void refuse_bare_bone(const std::string& name, const std::string& source,
                                   const std::string& user)
{
    throw InvalidInput(user + ": no face of " + source + " follows bone '" + name +
                       "' or one below it; name a bone that moves skin, or remove it");
}

/// Marks a joint and its descendants. [joints]
std::vector<unsigned char> branch_of(const Skeleton& skeleton, int root)
{
    std::vector<unsigned char> is_in(skeleton.size(), 0);
    for (int j = root; j < skeleton.size(); ++j) {
        const int parent = skeleton.joints()[j].parent;
        is_in[j] = j == root || (parent >= 0 && is_in[parent] != 0) ? 1 : 0;
    }
    return is_in;
}

} // namespace

SkinnedAvatar::SkinnedAvatar(std::string source, RiggedModel model)
    : Avatar(std::move(source), model.mesh.rest.triangles, model.mesh.rest.vertex_count(),
             clip_names(model.clips)),
      model_(std::move(model)), local_(model_.skeleton.rest_pose()), frames_(model_.skeleton.size()),
      shape_weights_(model_.mesh.shape_weights)
{
    for (const Clip& clip : model_.clips)
        travel_of_clip_.push_back(root_travel(clip));
}

std::string SkinnedAvatar::add_clip(Clip clip)
{
    const auto is_taken = [&](const std::string& name) {
        return std::any_of(clips().begin(), clips().end(), [&](const ClipName& c) { return c.name == name; });
    };
    const std::string name = clip.name;
    for (int number = 2; is_taken(clip.name); ++number)
        clip.name = name + "#" + std::to_string(number);
    travel_of_clip_.push_back(root_travel(clip));
    add_clip_name({clip.name, clip.duration});
    model_.clips.push_back(std::move(clip));
    return model_.clips.back().name;
}

Vec3 SkinnedAvatar::root_travel(const Clip& clip) const
{
    // The root is the first joint in tree order that the clip translates at all.
    int root = -1;
    for (const JointTrack& track : clip.tracks) {
        const std::vector<Key<Vec3>>& keys = track.translation.keys;
        const bool moves = keys.size() > 1 && keys.front().value != keys.back().value;
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
    travel.y() = 0.0; // an avatar that ends its clip crouching must not sink with every cycle
    return travel;
}

void SkinnedAvatar::pose_bones(const PoseAt& at, const Affine& world_from_avatar, View<Affine> bones)
{
    // Compute joint transforms: of the clip, of the bind pose, or a blend.
    const bool clip_shows = at.clip >= 0 && at.bind_weight < 1.0;
    if (clip_shows)
        sample(model_.clips[at.clip], model_.skeleton, at.time, local_);
    for (int j = 0; j < model_.skeleton.size(); ++j) {
        const JointTransform& rest = model_.skeleton.joints()[j].rest;
        if (!clip_shows)
            local_[j] = rest;
        else if (at.bind_weight > 0.0)
            local_[j] = blend(local_[j], rest, at.bind_weight);
    }

    // Compute joint frames in the world, then the bones that follow them, then the shapes.
    Affine world_from_file = compose(world_from_avatar, model_.metres_from_file);
    if (at.cycles != 0)
        world_from_file.col(3) +=
            world_from_avatar.leftCols<3>() * (double(at.cycles) * travel_of_clip_[at.clip]);
    joint_frames(model_.skeleton, local_, frames_);
    for (Affine& frame : frames_)
        frame = compose(world_from_file, frame);
    const int bone_count = int(model_.mesh.bones.size());
    for (int b = 0; b < bone_count; ++b) {
        const Bone& bone = model_.mesh.bones[b];
        bones[b] = compose(frames_[bone.joint], bone.joint_from_mesh);
    }
    pose_shapes(at, bones.subview(bone_count, int(shape_weights_.size())));
}

void SkinnedAvatar::pose_shapes(const PoseAt& at, View<Affine> maps)
{
    const std::vector<double>& rest = model_.mesh.shape_weights;
    if (at.clip >= 0)
        sample_shapes(model_.clips[at.clip], rest, at.time, shape_weights_);
    const double bind_weight = at.clip >= 0 ? at.bind_weight : 1.0;
    for (int s = 0; s < maps.size(); ++s) {
        const double weight = (1.0 - bind_weight) * shape_weights_[s] + bind_weight * rest[s];
        maps[s] = weight * identity_affine();
    }
}

std::vector<unsigned char> SkinnedAvatar::faces_on_bones(const std::vector<std::string>& bones,
                                                         const std::string& user) const
{
    std::vector<unsigned char> marked(triangles().size(), 0);
    const std::vector<int> joint_of = heaviest_joints(model_.mesh);
    for (const std::string& name : bones) {
        const std::vector<unsigned char> is_in =
            branch_of(model_.skeleton, require_bone(model_.skeleton, name, source(), user));
        if (std::none_of(joint_of.begin(), joint_of.end(), [&](int joint) { return is_in[joint] != 0; }))
            refuse_bare_bone(name, source(), user);
        for (size_t t = 0; t < marked.size(); ++t)
            if (is_in[joint_of[t]] != 0)
                marked[t] = 1;
    }
    return marked;
}

std::string SkinnedAvatar::bone_at(int vertex) const
{
    const SkinView skin = model_.mesh.skin();
    const Influence* first = skin.influences.data() + skin.first[vertex];
    const Influence* last = skin.influences.data() + skin.first[vertex + 1];
    const Influence* heaviest = std::max_element(
        first, last, [](const Influence& a, const Influence& b) { return a.weight < b.weight; });
    return heaviest == last ? "" : model_.skeleton.joints()[model_.mesh.bones[heaviest->bone].joint].name;
}

} // namespace toile::avatars
