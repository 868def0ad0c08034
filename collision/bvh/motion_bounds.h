#pragma once

#include <vector>

#include "collision/bvh/cell_grid.h"

namespace toile::collision {

/// MotionBounds as plain data, on CPU or GPU.
struct MotionView {
    /// Distance [m] up to which surface points count.
    static constexpr double kReach = 0.1;

    CellGrid grid;
    View<const Bounds> motion; ///< [cells] bounds of displacements in the cell and its 26 neighbours [m]

    /// Bounds of the displacements [m] of all surface points within kReach of x at present; null if there are
    /// none.
    TOILE_HD const Bounds* around(const Vec3& x) const
    {
        const int cell = grid.nearest_to(x, 1);
        if (cell < 0 || motion[cell].lower.x() > motion[cell].upper.x())
            return nullptr;
        return &motion[cell];
    }
};

/// Local bounds on how surface points have moved from one pose of a mesh to the next, on a coarse grid.
class MotionBounds {
public:
    /// Computes the bounds. O(vertices + triangles + cells).
    /// @param triangles  [triangles]
    /// @param before     [vertices] positions in the earlier pose [m]
    /// @param now        [vertices] positions in the present pose [m]
    /// @param box        bounds of `now` [m]
    void build(View<const Triangle> triangles, View<const Vec3> before, View<const Vec3> now,
               const Bounds& box);

    MotionView view() const { return {grid_, motion_}; } ///< borrowed until the next build()

private:
    CellGrid grid_;
    std::vector<CellGrid::Cell> cell_of_; ///< [vertices]
    std::vector<Bounds> cell_bounds_;     ///< [cells] displacements of the surface in the cell [m]
    std::vector<Bounds> motion_;          ///< see MotionView
};

} // namespace toile::collision
