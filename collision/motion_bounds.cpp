#include "collision/motion_bounds.h"

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
    std::vector<Bounds> own(grid_.cell_count());
    for (const Triangle& corner : triangles) {
        Bounds place, motion;
        for (const int v : corner) {
            place.extend(now[v]);
            motion.extend(now[v] - before[v]);
        }
        grid_.for_cells(grid_.cell_of(place.lower), grid_.cell_of(place.upper),
                        [&](int cell) { extend(own[cell], motion); });
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
