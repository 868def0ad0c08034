#pragma once

/// Kernels that compute MotionBounds, with the same bodies and the same bits on CPU and GPU. Minimum and
/// maximum do not depend on the order of threads.

#include "collision/bvh/cell_grid.h"
#include "core/compute/shared_bounds.h"

namespace toile::collision {

/// Extends a box while other threads extend it too.
TOILE_HD inline void extend_shared(Bounds& box, const Bounds& by)
{
    for (int k = 0; k < 3; ++k) {
        lower_shared(box.lower[k], by.lower[k]);
        raise_shared(box.upper[k], by.upper[k]);
    }
}

/// Moved mesh, and the bounds of the displacements in each cell of a grid over it.
struct MovedMesh {
    CellGrid grid;
    View<const Triangle> triangles; ///< [triangles]
    View<const Vec3> before, now;   ///< [vertices] [m]
    View<CellGrid::Cell> cell_of;   ///< [vertices] cell of `now`
    View<Bounds> cell_bounds;       ///< [cells] [m]

    TOILE_HD Vec3 motion(int v) const { return now[v] - before[v]; }
};

/// Empties the bounds of cell i.
struct ClearMotion {
    View<Bounds> cell_bounds; ///< [cells] out
    TOILE_HD void operator()(int i) const { cell_bounds[i] = Bounds(); }
};

/// Adds vertex v to its cell. Vertices cover every triangle that lies within one cell, which is the usual
/// case.
struct AddVertexMotion {
    MovedMesh mesh;

    TOILE_HD void operator()(int v) const
    {
        const CellGrid::Cell cell = mesh.grid.cell_of(mesh.now[v]);
        mesh.cell_of[v] = cell;
        const Vec3 motion = mesh.motion(v);
        extend_shared(mesh.cell_bounds[mesh.grid.number_of(cell)], {motion, motion});
    }
};

/// Adds triangle t to the cells between those of its corners, if it spans several.
struct AddTriangleMotion {
    MovedMesh mesh;

    TOILE_HD void operator()(int t) const
    {
        const Triangle& corner = mesh.triangles[t];
        CellGrid::Cell first = mesh.cell_of[corner[0]], last = first;
        for (int c = 1; c < 3; ++c)
            for (int k = 0; k < 3; ++k) {
                const int at = mesh.cell_of[corner[c]][k];
                first[k] = at < first[k] ? at : first[k];
                last[k] = at > last[k] ? at : last[k];
            }
        if (first[0] == last[0] && first[1] == last[1] && first[2] == last[2])
            return;
        Bounds motion;
        for (int c = 0; c < 3; ++c)
            motion.extend(mesh.motion(corner[c]));
        mesh.grid.for_cells(first, last, [&](int cell) { extend_shared(mesh.cell_bounds[cell], motion); });
    }
};

/// Unites the bounds of cell i and its 26 neighbours.
struct SpreadMotion {
    CellGrid grid;
    View<const Bounds> cell_bounds; ///< [cells] [m]
    View<Bounds> motion;            ///< [cells] out, see MotionView [m]

    TOILE_HD void operator()(int i) const
    {
        const auto [x, y, z] = grid.cell_at(i);
        Bounds bounds;
        grid.for_cells({x - 1, y - 1, z - 1}, {x + 1, y + 1, z + 1}, [&](int other) {
            if (cell_bounds[other].empty())
                return;
            bounds.extend(cell_bounds[other].lower);
            bounds.extend(cell_bounds[other].upper);
        });
        motion[i] = bounds;
    }
};

/// Computes the bounds of a moved mesh; parallel_for of the space is included before.
/// @param motion  [cells] out, see MotionView [m]
template <class Space>
void find_motion(const Space& space, const MovedMesh& mesh, View<Bounds> motion)
{
    parallel_for(space, "collision/clear_motion", mesh.cell_bounds.size(), ClearMotion{mesh.cell_bounds});
    parallel_for(space, "collision/vertex_motion", mesh.now.size(), AddVertexMotion{mesh});
    parallel_for(space, "collision/triangle_motion", mesh.triangles.size(), AddTriangleMotion{mesh});
    parallel_for(space, "collision/spread_motion", motion.size(),
                 SpreadMotion{mesh.grid, mesh.cell_bounds, motion});
}

} // namespace toile::collision
