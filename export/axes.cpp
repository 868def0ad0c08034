#include "export/axes.h"

namespace toile::exports {

namespace {

Vec3 z_up(const Vec3& x) { return {x.x(), -x.z(), x.y()}; }
Vec3 y_up(const Vec3& x) { return {x.x(), x.z(), -x.y()}; }

} // namespace

void change_axes(const Axes& from, const Axes& to, std::vector<Vec3>& positions)
{
    const double scale = from.metres_per_unit() / to.metres_per_unit();
    for (Vec3& x : positions) {
        if (from.has_z_up() != to.has_z_up())
            x = to.has_z_up() ? z_up(x) : y_up(x);
        if (scale != 1.0)
            x *= scale;
    }
}

} // namespace toile::exports
