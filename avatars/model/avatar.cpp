#include "avatars/model/avatar.h"

#include "core/base/error.h"
#include "core/compute/parallel.h"
#include "core/mesh/winding.h"

namespace toile::avatars {

int Avatar::clip_index(const std::string& name) const
{
    std::vector<std::string> names;
    std::string list;
    for (size_t i = 0; i < clips_.size(); ++i) {
        if (clips_[i].name == name)
            return int(i);
        names.push_back(clips_[i].name);
        list += (list.empty() ? "'" : ", '") + clips_[i].name + "'";
    }
    if (clips_.empty())
        throw InvalidInput(source_ + ": no clip '" + name + "'; it has no clips, leave the clip name empty");
    const std::string nearest = nearest_word(name, names);
    throw InvalidInput(source_ + ": no clip '" + name + "'; " +
                       (nearest.empty() ? "" : "did you mean '" + nearest + "'? ") + "It has " + list);
}

std::vector<unsigned char> Avatar::faces_on_bones(const std::vector<std::string>& bones,
                                                  const std::string& user) const
{
    if (!bones.empty())
        throw InvalidInput(user + ": " + source_ + " has no bones; remove '" + bones.front() + "'");
    return std::vector<unsigned char>(triangles_.size(), 0);
}

void Avatar::skin_vertices(const SkinView& skin, View<const Affine> bones, View<Vec3> out)
{
    parallel_for(kCpu, "avatars/skin", skin.rest.size(), SkinVertices{skin, bones, out});
}

void Avatar::pose(const PoseAt& at, const Affine& world_from_avatar, View<Vec3> out)
{
    std::vector<Affine> bones(static_cast<size_t>(bone_count()));
    pose_bones(at, world_from_avatar, bones);
    skin_vertices(bones, out);
}

void Avatar::face_outwards()
{
    TriangleMesh mesh{std::vector<Vec3>(size_t(vertex_count_)), std::move(triangles_)};
    pose({}, identity_affine(), mesh.positions);
    turned_count_ = toile::face_outwards(mesh);
    triangles_ = std::move(mesh.triangles);
}

} // namespace toile::avatars
