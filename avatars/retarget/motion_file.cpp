#include "avatars/retarget/motion_file.h"

#include <algorithm>

#include "avatars/import/assimp_import.h"
#include "avatars/import/gltf_import.h"
#include "core/base/error.h"

namespace toile::avatars {

namespace {

[[noreturn]] void refuse_name(const SkeletalMotion& motion, const std::string& name)
{
    std::vector<std::string> names;
    std::string list;
    for (const Clip& clip : motion.clips) {
        names.push_back(clip.name);
        list += (list.empty() ? "'" : ", '") + clip.name + "'";
    }
    const std::string nearest = nearest_word(name, names);
    throw InvalidInput(motion.source + ": no clip '" + name + "'; " +
                       (nearest.empty() ? "" : "did you mean '" + nearest + "'? ") + "It has " + list);
}

} // namespace

SkeletalMotion read_motion_file(const std::filesystem::path& file)
{
    if (!std::filesystem::is_regular_file(file))
        throw InvalidInput(file.string() +
                           ": no such file; give the path of a .bvh, .fbx, .glb or .gltf motion");
    return is_gltf(file) ? import_gltf_motion(file) : import_skeletal_motion(file);
}

const Clip& clip_named(const SkeletalMotion& motion, const std::string& name)
{
    if (motion.clips.empty())
        throw InvalidInput(motion.source + ": has no clip; name a file with an animation of bones");
    const auto found =
        name.empty() ? std::max_element(motion.clips.begin(), motion.clips.end(),
                                        [](const Clip& a, const Clip& b) { return a.duration < b.duration; })
                     : std::find_if(motion.clips.begin(), motion.clips.end(),
                                    [&](const Clip& clip) { return clip.name == name; });
    if (found == motion.clips.end())
        refuse_name(motion, name);
    if (found->tracks.empty())
        throw InvalidInput(motion.source + ": clip '" + found->name +
                           "' moves no bone; name a clip or a file with an animation of bones");
    return *found;
}

} // namespace toile::avatars
