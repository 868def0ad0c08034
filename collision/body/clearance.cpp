#include "collision/body/clearance.h"

#include <algorithm>

#include "collision/body/clearance_kernels.h"
#include "core/compute/parallel.h"

namespace toile::collision {

void Clearance::follow(View<const Vec3> x, const MeshCollider& mesh)
{
    const FollowClearance::Mesh since = FollowClearance::since(move_count_, mesh.move_count());
    move_count_ = mesh.move_count();
    parallel_for(kCpu, "collision/clearance", x.size(),
                 FollowClearance{x, since, mesh.last_motion().view(), x_, bound_});
}

void Clearance::record(int vertex, double distance, int triangle)
{
    nearest_[vertex] = triangle;
    bound_[vertex] = std::min(distance, MotionView::kReach);
}

} // namespace toile::collision
