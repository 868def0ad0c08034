#include "collision/motion_bounds.h"

#include "collision/motion_kernels.h"
#include "core/backend/parallel.h"

namespace toile {

void MotionBounds::build(View<const Triangle> triangles, View<const Vec3> before, View<const Vec3> now,
                         const Bounds& box)
{
    grid_ = CellGrid(box, MotionView::kReach);
    cell_of_.resize(now.size());
    own_.assign(grid_.cell_count(), Bounds{});
    motion_.resize(own_.size());
    const MovedMesh mesh{grid_, triangles, before, now, cell_of_, own_};
    parallel_for(kCpu, "collision/vertex_motion", now.size(), AddVertexMotion{mesh});
    parallel_for(kCpu, "collision/triangle_motion", triangles.size(), AddTriangleMotion{mesh});
    parallel_for(kCpu, "collision/spread_motion", int(own_.size()), SpreadMotion{grid_, own_, motion_});
}

} // namespace toile
