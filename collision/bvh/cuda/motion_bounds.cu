#include "collision/bvh/cuda/motion_bounds.h"

#include "collision/bvh/motion_kernels.h"
#include "core/compute/cuda/grown_array.h"
#include "core/compute/cuda/parallel.cuh"

namespace toile::collision {

DeviceMotionBounds::DeviceMotionBounds(const CudaSpace& space)
    : space_(space), cell_of_(space, "motion/cell_of"), cell_bounds_(space, "motion/cell_bounds"),
      motion_(space, "motion/motion")
{
}

void DeviceMotionBounds::build(View<const Triangle> triangles, View<const Vec3> before, View<const Vec3> now,
                               const Bounds& box)
{
    grid_ = CellGrid(box, MotionView::kReach);
    const int cells = grid_.cell_count();
    find_motion(
        space_,
        {grid_, triangles, before, now, first_items(cell_of_, now.size()), first_items(cell_bounds_, cells)},
        first_items(motion_, cells));
}

} // namespace toile::collision
