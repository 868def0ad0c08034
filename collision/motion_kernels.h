#pragma once

/// How MotionBounds are found. The same bodies on CPU and GPU, and the same bits: the least and the largest
/// of all do not depend on who comes first.

#include "collision/cell_grid.h"
#include "core/backend/shared_bounds.h"

namespace toile {

/// Extends a box that others extend at the same time.
TOILE_HD inline void extend_shared(Bounds& box, const Bounds& by)
{
    for (int k = 0; k < 3; ++k) {
        lower_shared(box.lower[k], by.lower[k]);
        raise_shared(box.upper[k], by.upper[k]);
    }
}

/// A mesh that has moved, and the displacements in each cell of a grid around it.
struct MovedMesh {
    CellGrid grid;
    View<const Triangle> triangles; ///< [triangles]
    View<const Vec3> before, now;   ///< [vertices] [m]
    View<CellGrid::Cell> cell_of;   ///< [vertices] of now
    View<Bounds> own;               ///< [cells] [m]

    TOILE_HD Vec3 motion(int v) const { return now[v] - before[v]; }
};

/// Nothing in cell i yet.
struct ClearMotion {
    View<Bounds> own; ///< [cells] out
    TOILE_HD void operator()(int i) const { own[i] = Bounds(); }
};

/// Vertex v. Vertices stand for all triangles that are in one cell, which are most.
struct AddVertexMotion {
    MovedMesh mesh;

    TOILE_HD void operator()(int v) const
    {
        const CellGrid::Cell cell = mesh.grid.cell_of(mesh.now[v]);
        mesh.cell_of[v] = cell;
        const Vec3 motion = mesh.motion(v);
        extend_shared(mesh.own[mesh.grid.number_of(cell)], {motion, motion});
    }
};

/// Triangle t, where it is between cells: in those around its corners'.
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
        mesh.grid.for_cells(first, last, [&](int cell) { extend_shared(mesh.own[cell], motion); });
    }
};

/// What is in cell i and in the 26 around it.
struct SpreadMotion {
    CellGrid grid;
    View<const Bounds> own; ///< [cells] [m]
    View<Bounds> motion;    ///< [cells] out, see MotionView [m]

    TOILE_HD void operator()(int i) const
    {
        const auto [x, y, z] = grid.cell_at(i);
        Bounds around;
        grid.for_cells({x - 1, y - 1, z - 1}, {x + 1, y + 1, z + 1}, [&](int other) {
            if (own[other].empty())
                return;
            around.extend(own[other].lower);
            around.extend(own[other].upper);
        });
        motion[i] = around;
    }
};

} // namespace toile
