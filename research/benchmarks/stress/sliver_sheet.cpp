#include "research/benchmarks/stress/sliver_sheet.h"

#include <numbers>

namespace toile::research::stress {

namespace {

/// Sheet over grid lines along x and z, every cell split by one diagonal. Seen from above, x points right and
/// z down.
TriangleMesh grid_sheet(const std::vector<double>& x, const std::vector<double>& z)
{
    TriangleMesh sheet;
    const int columns = int(x.size());
    for (const double down : z)
        for (const double right : x)
            sheet.positions.emplace_back(right, 0.0, down);
    for (int row = 0; row + 1 < int(z.size()); ++row)
        for (int column = 0; column + 1 < columns; ++column) {
            const int a = row * columns + column, b = a + 1, c = a + columns, d = c + 1;
            sheet.triangles.insert(sheet.triangles.end(), {Triangle(a, c, d), Triangle(a, d, b)});
        }
    return sheet;
}

std::vector<double> even_lines(double side, int cells)
{
    std::vector<double> lines;
    for (int i = 0; i <= cells; ++i)
        lines.push_back(side * (double(i) / cells - 0.5));
    return lines;
}

/// Doubles every inner line along x: columns of needles between wide columns.
TriangleMesh needle_sheet(double side, int cells, double aspect)
{
    std::vector<double> x;
    const std::vector<double> even = even_lines(side, cells);
    for (int i = 0; i <= cells; ++i) {
        x.push_back(even[i]);
        if (i > 0 && i < cells)
            x.push_back(even[i] + side / cells / aspect);
    }
    return grid_sheet(x, even);
}

/// Inserts a vertex close to the middle of every diagonal and connects it to the corners of its triangle.
TriangleMesh cap_sheet(double side, int cells, double aspect)
{
    const TriangleMesh even = grid_sheet(even_lines(side, cells), even_lines(side, cells));
    const double height = std::numbers::sqrt2 * side / cells / aspect;
    const Vec3 beside = height / std::numbers::sqrt2 * Vec3(1.0, 0.0, -1.0);
    TriangleMesh sheet{even.positions, {}};
    for (size_t t = 0; t < even.triangles.size(); t += 2) {
        const Triangle& upper = even.triangles[t + 1]; // a, d, b with the diagonal a d
        const int a = upper[0], d = upper[1], b = upper[2], p = sheet.vertex_count();
        sheet.positions.push_back(0.5 * (even.positions[a] + even.positions[d]) + beside);
        sheet.triangles.insert(sheet.triangles.end(),
                               {even.triangles[t], Triangle(a, d, p), Triangle(d, b, p), Triangle(b, a, p)});
    }
    return sheet;
}

} // namespace

TriangleMesh sliver_sheet(Sliver kind, double side, int cells, double aspect)
{
    return kind == Sliver::Needle ? needle_sheet(side, cells, aspect) : cap_sheet(side, cells, aspect);
}

} // namespace toile::research::stress
