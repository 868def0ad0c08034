#include "research/benchmarks/quadrature/sheet.h"

#include <cmath>
#include <random>

#include "core/linear/cholesky.h"

namespace toile::research {

namespace {

constexpr double kDensity = 0.2;          // [kg/m^2]
constexpr double kTimeStep = 1.0 / 120.0; // [s]

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

} // namespace

Sheet unit_sheet(int side, double jitter)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> shift(-jitter, jitter);
    const double cell = 1.0 / (side - 1);
    Sheet sheet;
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column) {
            const bool is_inner = row > 0 && row < side - 1 && column > 0 && column < side - 1;
            const Vec2 moved = is_inner ? Vec2(shift(random), shift(random)) : Vec2::Zero();
            sheet.uv.push_back(cell * (Vec2(column, row) + moved));
        }
    for (int row = 0; row + 1 < side; ++row)
        for (int column = 0; column + 1 < side; ++column) {
            // Diagonals alternate, so that no direction is preferred.
            const int a = row * side + column, b = a + 1, c = a + side, d = c + 1;
            if ((row + column) % 2 == 0) {
                sheet.triangles.push_back({a, b, d});
                sheet.triangles.push_back({a, d, c});
            } else {
                sheet.triangles.push_back({a, b, c});
                sheet.triangles.push_back({b, d, c});
            }
        }
    sheet.area.assign(sheet.uv.size(), 0.0);
    for (const Triangle& t : sheet.triangles)
        for (const int vertex : t)
            sheet.area[vertex] +=
                cross(sheet.uv[t[1]] - sheet.uv[t[0]], sheet.uv[t[2]] - sheet.uv[t[0]]) / 6.0;
    return sheet;
}

SparseMatrix sheet_matrix(const Sheet& sheet, double k, const std::vector<unsigned char>& fixed)
{
    Triplets entries;
    const auto add = [&](int row, int column, double value) {
        if (fixed.empty() || (!fixed[row] && !fixed[column]))
            entries.emplace_back(row, column, value);
    };
    for (int i = 0; i < sheet.vertex_count(); ++i)
        add(i, i, kDensity * sheet.area[i] / (kTimeStep * kTimeStep));
    for (const Triangle& t : sheet.triangles)
        for (int corner = 0; corner < 3; ++corner) {
            const int o = t[corner], i = t[(corner + 1) % 3], j = t[(corner + 2) % 3];
            const Vec2 a = sheet.uv[i] - sheet.uv[o], b = sheet.uv[j] - sheet.uv[o];
            const double weight = 0.5 * k * a.dot(b) / cross(a, b);
            add(i, i, weight);
            add(j, j, weight);
            add(i, j, -weight);
            add(j, i, -weight);
        }
    for (int i = 0; i < int(fixed.size()); ++i)
        if (fixed[i])
            entries.emplace_back(i, i, 1.0);
    SparseMatrix H(sheet.vertex_count(), sheet.vertex_count());
    H.setFromTriplets(entries.begin(), entries.end());
    return H;
}

std::vector<double> kernel_row(const SparseMatrix& H, int vertex)
{
    std::vector<Vec3> column(H.rows(), Vec3::Zero());
    column[vertex].x() = 1.0;
    Cholesky(H).solve(column, column);
    std::vector<double> u(column.size());
    for (size_t k = 0; k < u.size(); ++k)
        u[k] = column[k].x() / column[vertex].x();
    return u;
}

std::vector<Vec3> smooth_load(const Sheet& sheet)
{
    std::vector<Vec3> b;
    for (int i = 0; i < sheet.vertex_count(); ++i) {
        const double x = sheet.uv[i].x(), y = sheet.uv[i].y();
        const Vec3 q(x + 0.1 * std::sin(3.0 * y), y, 0.3 * std::cos(4.0 * x) * std::cos(2.0 * y));
        b.push_back(kDensity * sheet.area[i] / (kTimeStep * kTimeStep) * q);
    }
    return b;
}

} // namespace toile::research
