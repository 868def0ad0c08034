#include "collision/device_motion_bounds.h"

#include "collision/motion_kernels.h"
#include "core/backend/cuda/parallel.cuh"
#include "core/backend/cuda/roomy.h"

namespace toile {

DeviceMotionBounds::DeviceMotionBounds(const CudaSpace& space)
    : space_(space), cell_of_(space, "motion/cell_of"), own_(space, "motion/own"),
      motion_(space, "motion/motion")
{
}

void DeviceMotionBounds::build(View<const Triangle> triangles, View<const Vec3> before, View<const Vec3> now,
                               const Bounds& box)
{
    grid_ = CellGrid(box, MotionView::kReach);
    const int cells = grid_.cell_count();
    const MovedMesh mesh{
        grid_, triangles, before, now, first_items(cell_of_, now.size()), first_items(own_, cells)};
    first_items(motion_, cells);
    parallel_for(space_, "collision/device_clear_motion", cells, ClearMotion{mesh.own});
    parallel_for(space_, "collision/device_vertex_motion", now.size(), AddVertexMotion{mesh});
    parallel_for(space_, "collision/device_triangle_motion", triangles.size(), AddTriangleMotion{mesh});
    parallel_for(space_, "collision/device_spread_motion", cells,
                 SpreadMotion{grid_, mesh.own, motion_.view()});
}

} // namespace toile
