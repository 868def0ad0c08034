#include "collision/bvh/motion_bounds.h"

#include "collision/bvh/motion_kernels.h"
#include "core/compute/parallel.h"

namespace toile::collision {

void MotionBounds::build(View<const Triangle> triangles, View<const Vec3> before, View<const Vec3> now,
                         const Bounds& box)
{
    grid_ = CellGrid(box, MotionView::kReach);
    cell_of_.resize(now.size());
    cell_bounds_.assign(grid_.cell_count(), Bounds{});
    motion_.resize(cell_bounds_.size());
    const MovedMesh mesh{grid_, triangles, before, now, cell_of_, cell_bounds_};
    parallel_for(kCpu, "collision/vertex_motion", now.size(), AddVertexMotion{mesh});
    parallel_for(kCpu, "collision/triangle_motion", triangles.size(), AddTriangleMotion{mesh});
    parallel_for(kCpu, "collision/spread_motion", int(cell_bounds_.size()),
                 SpreadMotion{grid_, cell_bounds_, motion_});
}

} // namespace toile::collision
