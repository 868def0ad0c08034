#include "collision/bvh/motion_bounds.h"

#include "collision/bvh/motion_kernels.h"
#include "core/compute/parallel.h"

namespace toile::collision {

void MotionBounds::build(View<const Triangle> triangles, View<const Vec3> before, View<const Vec3> now,
                         const Bounds& box)
{
    grid_ = CellGrid(box, MotionView::kReach);
    cell_of_.resize(now.size());
    cell_bounds_.resize(grid_.cell_count());
    motion_.resize(grid_.cell_count());
    find_motion(kCpu, {grid_, triangles, before, now, cell_of_, cell_bounds_}, motion_);
}

} // namespace toile::collision
