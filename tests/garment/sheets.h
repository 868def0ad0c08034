#pragma once

#include <memory>

#include "core/pd/step/body.h"
#include "garment/energy/rest_shape.h"

/// Rectangular sheets and bodies shared by many tests.
namespace toile::test {

using namespace garment;

enum class Pattern { Regular, FlippedDiagonal, Irregular };

/// Rectangle [0, size.x] x [0, size.y] of (columns + 1) x (rows + 1) vertices, row by row (y outer, x inner).
/// Irregular moves inner vertices by up to 30 % of a cell (fixed seed) and picks diagonals at random.
struct Sheet {
    int columns = 0, rows = 0;
    std::vector<Vec2> uv;
    std::vector<Triangle> triangles;

    int at(int column, int row) const { return row * (columns + 1) + column; }
    std::shared_ptr<const RestShape> rest() const;

    /// Positions with u along x and v along z, at height 0.
    std::vector<Vec3> flat() const;
};
Sheet make_sheet(const Vec2& size, int columns, int rows, Pattern pattern = Pattern::Regular);

/// Masses for an areal density [kg/m^2].
std::vector<double> masses_of(const RestShape& rest, double areal_density);

/// Steps under gravity until no vertex moves faster than `speed` [m/s], for at most `max_steps`. True if it
/// came to rest.
bool run_to_rest(Body& body, double dt, const std::vector<unsigned char>& fixed, double speed, int max_steps);

} // namespace toile::test
