#include "avatars/model/static_avatar.h"

#include <numeric>

namespace toile::avatars {

StaticAvatar::StaticAvatar(std::string source, TriangleMesh mesh, const Affine& metres_from_file)
    : Avatar(std::move(source), std::move(mesh.triangles), mesh.vertex_count(), {}),
      positions_(std::move(mesh.positions)), first_(positions_.size() + 1),
      influences_(positions_.size(), {0, 1.0}), metres_from_file_(metres_from_file)
{
    std::iota(first_.begin(), first_.end(), 0);
}

void StaticAvatar::pose_bones(const PoseAt&, const Affine& world_from_avatar, View<Affine> bones)
{
    bones[0] = compose(world_from_avatar, metres_from_file_);
}

} // namespace toile::avatars
