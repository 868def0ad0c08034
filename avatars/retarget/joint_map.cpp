#include "avatars/retarget/joint_map.h"

#include "avatars/import/name_pairs.h"
#include "core/base/error.h"

namespace toile::avatars {

namespace {

std::string nearest_joint(const std::string& name, const Skeleton& skeleton)
{
    std::vector<std::string> names;
    for (const Joint& joint : skeleton.joints())
        names.push_back(joint.name);
    const std::string nearest = nearest_word(name, names);
    return nearest.empty()
               ? "name one of its " + std::to_string(names.size()) + " joints, as toile info lists them"
               : "did you mean '" + nearest + "'?";
}

int require_joint(const std::string& name, const Skeleton& skeleton, const std::string& source,
                  const std::string& place)
{
    const int joint = skeleton.find(name);
    if (joint < 0)
        throw InvalidInput(place + ": " + source + " has no joint '" + name + "'; " +
                           nearest_joint(name, skeleton));
    return joint;
}

} // namespace

JointMap map_by_names(const Skeleton& body, const SkeletalMotion& motion)
{
    JointMap source_of;
    for (const Joint& joint : body.joints())
        source_of.push_back(motion.skeleton.find(joint.name));
    return source_of;
}

JointMap read_joint_map(const std::filesystem::path& file, const SkinnedAvatar& body,
                        const SkeletalMotion& motion)
{
    const Skeleton& skeleton = body.model().skeleton;
    JointMap source_of(size_t(skeleton.size()), -1);
    for (const auto& [name, source] : read_name_pairs(file)) {
        const std::string place = file.string() + ": \"" + name + "\"";
        source_of[size_t(require_joint(name, skeleton, body.source(), place))] =
            require_joint(source, motion.skeleton, motion.source, place);
    }
    return source_of;
}

} // namespace toile::avatars
