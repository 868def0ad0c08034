#pragma once

#include <vector>

#include "collision/cell_grid.h"

namespace toile {

/// How surface points have moved from one pose of a mesh to the next: a box of displacements around every
/// place, on a coarse grid.
class MotionBounds {
public:
    /// Surface points this near [m] are counted.
    static constexpr double kReach = 0.1;

    /// O(vertices + triangles + cells).
    /// @param triangles  [triangles]
    /// @param before     [vertices] where they were [m]
    /// @param now        [vertices] where they are [m]
    /// @param box        around now [m]
    void build(View<const Triangle> triangles, View<const Vec3> before, View<const Vec3> now,
               const Bounds& box);

    /// The displacements [m] of all surface points that are within kReach of x now; empty where there are
    /// none.
    const Bounds& around(const Vec3& x) const;

private:
    CellGrid grid_;
    std::vector<Bounds> motion_; ///< [cells] of the surface in it and in the 26 cells around it [m]
};

} // namespace toile
