#include "collision/motion_bounds.h"

#include <algorithm>

#include "core/backend/parallel.h"

namespace toile {

namespace {

const Bounds kNothing;

void extend(Bounds& box, const Bounds& other)
{
    if (other.empty())
        return;
    box.extend(other.lower);
    box.extend(other.upper);
}

} // namespace

void MotionBounds::build(View<const Triangle> triangles, View<const Vec3> before, View<const Vec3> now)
{
    grid_ = CellGrid(bounds(now), kReach);
    std::vector<CellGrid::Cell> cell_of(now.size());
    parallel_for(kCpu, "collision/motion_cells", now.size(),
                 [&](int v) { cell_of[v] = grid_.cell_of(now[v]); });

    // Cells are in the order of coordinates: those of the box around a triangle are those of its corners.
    std::vector<Bounds> own(grid_.cell_count());
    for (const Triangle& corner : triangles) {
        CellGrid::Cell first = cell_of[corner[0]], last = first;
        Bounds motion;
        for (const int v : corner) {
            for (int k = 0; k < 3; ++k) {
                first[k] = std::min(first[k], cell_of[v][k]);
                last[k] = std::max(last[k], cell_of[v][k]);
            }
            motion.extend(now[v] - before[v]);
        }
        grid_.for_cells(first, last, [&](int number) { extend(own[number], motion); });
    }

    motion_.assign(own.size(), Bounds{});
    grid_.for_all([&](const CellGrid::Cell& cell) {
        const auto [x, y, z] = cell;
        Bounds& around = motion_[grid_.number_of(cell)];
        grid_.for_cells({x - 1, y - 1, z - 1}, {x + 1, y + 1, z + 1},
                        [&](int other) { extend(around, own[other]); });
    });
}

const Bounds& MotionBounds::around(const Vec3& x) const
{
    const int cell = grid_.nearest_to(x, 1);
    return cell < 0 ? kNothing : motion_[cell];
}

} // namespace toile
