#include "collision/motion_bounds.h"

#include <algorithm>

#include "core/backend/parallel.h"

namespace toile {

namespace {

/// Vertices and triangles in parts, each of which one task looks at with a grid of its own.
struct Parts {
    static constexpr int kMost = 32, kLeastSize = 2048;

    explicit Parts(int items)
        : size(std::max(kLeastSize, (items + kMost - 1) / kMost)), count((items + size - 1) / size)
    {
    }
    int begin(int part) const { return part * size; }

    int size, count;
};

void extend(Bounds& box, const Bounds& other)
{
    if (other.empty())
        return;
    box.extend(other.lower);
    box.extend(other.upper);
}

} // namespace

void MotionBounds::build(View<const Triangle> triangles, View<const Vec3> before, View<const Vec3> now,
                         const Bounds& box)
{
    grid_ = CellGrid(box, MotionView::kReach);
    const Parts parts(std::max(triangles.size(), now.size()));
    std::vector<std::vector<Bounds>> own_of(parts.count, std::vector<Bounds>(grid_.cell_count()));

    // Vertices. They stand for all triangles that are in one cell, which are most.
    std::vector<CellGrid::Cell> cell_of(now.size());
    parallel_for(
        kCpu, "collision/vertex_motion", parts.count,
        [&](int part) {
            for (int v = parts.begin(part); v < std::min(parts.begin(part + 1), now.size()); ++v) {
                cell_of[v] = grid_.cell_of(now[v]);
                own_of[part][grid_.number_of(cell_of[v])].extend(now[v] - before[v]);
            }
        },
        1);

    // Triangles between cells: in those around their corners'.
    parallel_for(
        kCpu, "collision/triangle_motion", parts.count,
        [&](int part) {
            for (int t = parts.begin(part); t < std::min(parts.begin(part + 1), triangles.size()); ++t) {
                const Triangle& corner = triangles[t];
                CellGrid::Cell first = cell_of[corner[0]], last = first;
                for (const int v : {corner[1], corner[2]})
                    for (int k = 0; k < 3; ++k) {
                        first[k] = std::min(first[k], cell_of[v][k]);
                        last[k] = std::max(last[k], cell_of[v][k]);
                    }
                if (first == last)
                    continue;
                Bounds motion;
                for (const int v : corner)
                    motion.extend(now[v] - before[v]);
                grid_.for_cells(first, last, [&](int cell) { extend(own_of[part][cell], motion); });
            }
        },
        1);
    std::vector<Bounds> own(grid_.cell_count());
    for (const std::vector<Bounds>& others : own_of)
        for (size_t cell = 0; cell < own.size(); ++cell)
            extend(own[cell], others[cell]);

    motion_.assign(own.size(), Bounds{});
    grid_.for_all([&](const CellGrid::Cell& cell) {
        const auto [x, y, z] = cell;
        Bounds& around = motion_[grid_.number_of(cell)];
        grid_.for_cells({x - 1, y - 1, z - 1}, {x + 1, y + 1, z + 1},
                        [&](int other) { extend(around, own[other]); });
    });
}

} // namespace toile
