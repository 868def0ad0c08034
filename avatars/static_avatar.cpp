#include "avatars/static_avatar.h"

#include "avatars/skinning_kernels.h"
#include "core/backend/parallel.h"

namespace toile {

StaticAvatar::StaticAvatar(std::string source, TriangleMesh mesh, const Affine& metres_from_file)
    : Avatar(std::move(source), std::move(mesh.triangles), mesh.vertex_count(), {}),
      positions_(std::move(mesh.positions)), metres_from_file_(metres_from_file)
{
}

void StaticAvatar::pose(const PoseAt&, const Affine& world_from_avatar, View<Vec3> out)
{
    parallel_for(kCpu, "avatars/place", vertex_count(),
                 PlaceVertices{positions_, compose(world_from_avatar, metres_from_file_), out});
}

} // namespace toile
