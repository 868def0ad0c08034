#pragma once

/// Moved meshes, for tests of motion bounds.

#include "core/mesh/triangle_mesh.h"
#include "tests/collision/soups.h"

namespace toile::test {

struct MotionCase {
    std::vector<Triangle> triangles;
    std::vector<Vec3> before, now;

    Bounds box() const { return bounds(now); }
};

/// Fine sheet whose displacement grows slightly from one end to the other, and triangles of all sizes, some
/// across many cells, each vertex moving independently.
inline MotionCase motion_case(Random& random)
{
    Soup soup = random_soup(random);
    add_sheet(soup, 40, 0.02, 0.3);
    MotionCase made{soup.triangles, {}, soup.x};
    for (const Vec3& x : made.now)
        made.before.push_back(x - 0.02 * random.point() - Vec3(0.1 * x.x(), 0.0, 0.03));
    return made;
}

} // namespace toile::test
