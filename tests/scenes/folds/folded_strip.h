#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "core/compute/types.h"

namespace toile::test {

/// Strip along x in the plane y = 0, of square cells of 1 cm, its outer side up. The middle column of
/// vertices is a line of folds.
struct Strip {
    int columns = 20, rows = 4;

    int vertex(int column, int row) const { return column * (rows + 1) + row; }
    int vertex_count() const { return (columns + 1) * (rows + 1); }

    std::string obj() const
    {
        std::string text;
        for (int i = 0; i <= columns; ++i)
            for (int k = 0; k <= rows; ++k)
                text += "v " + std::to_string(0.01 * i) + " 0 " + std::to_string(0.01 * k) + "\n";
        for (int i = 0; i < columns; ++i)
            for (int k = 0; k < rows; ++k) {
                text += "f";
                for (const auto& [di, dk] : {std::pair{0, 0}, {0, 1}, {1, 1}, {1, 0}})
                    text += " " + std::to_string(vertex(i + di, k + dk) + 1);
                text += "\n";
            }
        return text;
    }

    /// "[1, 2, 3]": vertices of a column.
    std::string column(int i) const
    {
        std::string text;
        for (int k = 0; k <= rows; ++k)
            text += (k == 0 ? "[" : ", ") + std::to_string(vertex(i, k));
        return text + "]";
    }

    /// Vertices of the first columns.
    std::string first_columns(int count) const
    {
        std::string text;
        for (int v = 0; v < vertex(count, 0); ++v)
            text += (v == 0 ? "[" : ", ") + std::to_string(v);
        return text + "]";
    }

    /// Angle by which the cells right of the middle are raised from the plane [rad], in row k of vertices.
    double angle(View<const Vec3> x, int k = 0) const
    {
        const Vec3 right = x[vertex(columns / 2 + 1, k)] - x[vertex(columns / 2, k)];
        return std::atan2(right.y(), right.x());
    }
};

} // namespace toile::test
