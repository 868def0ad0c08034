#pragma once

#include <vector>

#include "collision/cell_grid.h"

namespace toile {

/// MotionBounds as plain data, on CPU or GPU.
struct MotionView {
    /// Surface points this near [m] are counted.
    static constexpr double kReach = 0.1;

    CellGrid grid;
    View<const Bounds> motion; ///< [cells] of the surface in it and in the 26 cells around it [m]

    /// The displacements [m] of all surface points that are within kReach of x now; null where there are
    /// none.
    TOILE_HD const Bounds* around(const Vec3& x) const
    {
        const int cell = grid.nearest_to(x, 1);
        if (cell < 0 || motion[cell].lower.x() > motion[cell].upper.x())
            return nullptr;
        return &motion[cell];
    }
};

/// How surface points have moved from one pose of a mesh to the next: a box of displacements around every
/// place, on a coarse grid.
class MotionBounds {
public:
    /// O(vertices + triangles + cells).
    /// @param triangles  [triangles]
    /// @param before     [vertices] where they were [m]
    /// @param now        [vertices] where they are [m]
    /// @param box        around now [m]
    void build(View<const Triangle> triangles, View<const Vec3> before, View<const Vec3> now,
               const Bounds& box);

    MotionView view() const { return {grid_, motion_}; } ///< borrowed until the next build()

private:
    CellGrid grid_;
    std::vector<CellGrid::Cell> cell_of_; ///< [vertices]
    std::vector<Bounds> own_;             ///< [cells] of the surface in it [m]
    std::vector<Bounds> motion_;          ///< see MotionView
};

} // namespace toile
