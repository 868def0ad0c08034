#include "avatars/model/skeleton.h"

#include "core/base/error.h"

namespace toile::avatars {

Affine compose(const Affine& outer, const Affine& inner)
{
    Affine result;
    result.leftCols<3>() = outer.leftCols<3>() * inner.leftCols<3>();
    result.col(3) = outer.leftCols<3>() * inner.col(3) + outer.col(3);
    return result;
}

Affine inverse(const Affine& map)
{
    Affine result;
    result.leftCols<3>() = map.leftCols<3>().inverse();
    result.col(3) = -result.leftCols<3>() * map.col(3);
    return result;
}

Affine JointTransform::matrix() const
{
    Affine result;
    result.leftCols<3>() = rotation.toRotationMatrix() * scale.asDiagonal();
    result.col(3) = translation;
    return result;
}

JointTransform blend(const JointTransform& a, const JointTransform& b, double weight)
{
    return {(1.0 - weight) * a.translation + weight * b.translation, a.rotation.slerp(weight, b.rotation),
            (1.0 - weight) * a.scale + weight * b.scale};
}

int Skeleton::add(Joint joint)
{
    const int index = size();
    if (joint.parent < -1 || joint.parent >= index)
        throw InvalidInput("joint '" + joint.name + "': parent " + std::to_string(joint.parent) +
                           " is not an earlier joint (0 to " + std::to_string(index - 1) + ", or -1)");
    index_of_.emplace(joint.name, index);
    joints_.push_back(std::move(joint));
    return index;
}

int Skeleton::find(const std::string& name) const
{
    const auto found = index_of_.find(name);
    return found == index_of_.end() ? -1 : found->second;
}

int Skeleton::require(const std::string& name, const std::string& user) const
{
    if (const int joint = find(name); joint >= 0)
        return joint;
    std::vector<std::string> names;
    for (const Joint& joint : joints_)
        names.push_back(joint.name);
    const std::string nearest = nearest_word(name, names);
    throw InvalidInput(user + ": no joint '" + name + "' in the skeleton of " + std::to_string(size()) +
                       " joints" + (nearest.empty() ? "" : "; the nearest is '" + nearest + "'") +
                       "; every bone that a mesh or clip names must be a node of its file");
}

std::vector<JointTransform> Skeleton::rest_pose() const
{
    std::vector<JointTransform> pose;
    for (const Joint& joint : joints_)
        pose.push_back(joint.rest);
    return pose;
}

void joint_frames(const Skeleton& skeleton, View<const JointTransform> local, View<Affine> out)
{
    for (int j = 0; j < skeleton.size(); ++j) {
        const int parent = skeleton.joints()[j].parent;
        out[j] = parent < 0 ? local[j].matrix() : compose(out[parent], local[j].matrix());
    }
}

} // namespace toile::avatars
