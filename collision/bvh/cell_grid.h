#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/mesh/triangle_mesh.h"

namespace toile::collision {

/// Grid of equal, numbered cubes over a box.
class CellGrid {
public:
    using Cell = std::array<int, 3>;

    CellGrid() = default;

    /// @param size  edge of a cell [m]; enlarged if the longest side would have more than 64 cells
    CellGrid(const Bounds& box, double size)
        : origin_(box.lower), size_(std::max(size, (box.upper - box.lower).maxCoeff() / kMaxCells))
    {
        for (int k = 0; k < 3; ++k)
            count_[k] = 1 + int((box.upper[k] - box.lower[k]) / size_);
    }

    TOILE_HD int cell_count() const { return count_[0] * count_[1] * count_[2]; }
    TOILE_HD int number_of(const Cell& cell) const
    {
        return (cell[2] * count_[1] + cell[1]) * count_[0] + cell[0];
    }

    TOILE_HD Cell cell_at(int number) const
    {
        return {number % count_[0], number / count_[0] % count_[1], number / (count_[0] * count_[1])};
    }

    /// Cell of a point; it may lie outside the grid, by at most two cells.
    TOILE_HD Cell cell_of(const Vec3& x) const
    {
        Cell cell;
        for (int k = 0; k < 3; ++k)
            cell[k] = int(std::clamp(std::floor((x[k] - origin_[k]) / size_), -2.0, count_[k] + 1.0));
        return cell;
    }

    /// Number of the cell nearest to x, or -1 if x lies more than `beside` cells outside.
    TOILE_HD int nearest_to(const Vec3& x, int beside) const
    {
        Cell cell = cell_of(x);
        for (int k = 0; k < 3; ++k) {
            if (cell[k] < -beside || cell[k] >= count_[k] + beside)
                return -1;
            cell[k] = std::clamp(cell[k], 0, count_[k] - 1);
        }
        return number_of(cell);
    }

    /// Calls visit(number) for the cells of the grid between `first` and `last` along each axis, both
    /// included.
    template <typename Visit>
    TOILE_HD void for_cells(const Cell& first, const Cell& last, const Visit& visit) const
    {
        for (int z = std::max(first[2], 0); z <= std::min(last[2], count_[2] - 1); ++z)
            for (int y = std::max(first[1], 0); y <= std::min(last[1], count_[1] - 1); ++y)
                for (int x = std::max(first[0], 0); x <= std::min(last[0], count_[0] - 1); ++x)
                    visit(number_of({x, y, z}));
    }

private:
    static constexpr int kMaxCells = 64;

    Vec3 origin_ = Vec3::Zero(); ///< [m]
    double size_ = 1.0;          ///< edge of a cell [m]
    Cell count_{0, 0, 0};
};

} // namespace toile::collision
