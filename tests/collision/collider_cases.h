#pragma once

/// Cloth near meshes, for searches of their pairs.

#include <string>
#include <vector>

#include "collision/body/detect.h"
#include "tests/collision/shapes_for_tests.h"
#include "tests/collision/soups.h"

namespace toile::test {

using namespace collision;

struct ColliderCase {
    std::string name;
    TriangleMesh cloth;
    MovingMesh mesh;
    std::vector<double> reach; ///< [vertices] or empty
    DetectSettings settings;
};

/// Mesh whose vertices all move independently.
inline MovingMesh shaken(const TriangleMesh& mesh, double size, Random& random)
{
    MovingMesh moving{mesh.triangles, mesh.positions, mesh.positions};
    for (Vec3& x : moving.x_t1)
        x += size * random.point() + Vec3(0.5 * size, 0, 0);
    return moving;
}

/// Sheet around a dented ball, in front of its surface and behind.
inline ColliderCase ball_case(Random& random, int cells, int levels)
{
    ColliderCase made{"around a ball", testing::sheet_mesh(0.5, cells, 0.0), {}, {}, {}};
    const Vec3 center(0.4, 1.2, -0.3);
    TriangleMesh ball = testing::sphere_mesh(center, 0.15, levels);
    for (Vec3& x : ball.positions)
        x += 0.004 * random.point();
    made.mesh = shaken(ball, 0.003, random);
    for (Vec3& x : made.cloth.positions) {
        const double along = std::hypot(x.x(), x.z()) / 0.15;
        const double azimuth = std::atan2(x.z(), x.x());
        const Vec3 outwards(std::sin(along) * std::cos(azimuth), std::cos(along),
                            std::sin(along) * std::sin(azimuth));
        x = center + (0.155 + random.uniform(-0.006, 0.006)) * outwards + 0.001 * random.point();
    }
    return made;
}

/// Gives some vertices a smaller search radius, and some none.
inline void add_reach(ColliderCase& made, Random& random)
{
    for (size_t v = 0; v < made.cloth.positions.size(); ++v)
        made.reach.push_back(random.below(4) == 0 ? -std::numeric_limits<double>::infinity()
                                                  : made.settings.radius * random.uniform(0.2, 1.0));
}

/// Soup in soup: unconnected triangles, shared corners and repeated triangles.
inline ColliderCase soup_in_soup(Random& random)
{
    const auto mesh = [&] {
        const Soup soup = random_soup(random);
        TriangleMesh made{soup.x, {}};
        for (const Triangle& t : soup.triangles)
            if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
                made.triangles.push_back(t);
        return made;
    };
    ColliderCase made{"soup in soup", mesh(), {}, {}, {}};
    made.mesh = shaken(mesh(), 0.02, random);
    made.settings.radius = 0.1;
    made.settings.max_depth = 0.2;
    return made;
}

/// Sheet between two overlapping balls and in the groove around them.
inline ColliderCase between_balls(Random& random)
{
    ColliderCase made{"between balls", testing::sheet_mesh(0.4, 40, 0.0), {}, {}, {}};
    TriangleMesh balls = testing::merged(testing::sphere_mesh(Vec3(0, 0.098, 0), 0.1, 4),
                                         testing::sphere_mesh(Vec3(0, -0.097, 0.01), 0.1, 4));
    for (Vec3& x : balls.positions)
        x += 1e-3 * random.point();
    made.mesh = shaken(balls, 0.002, random);
    for (Vec3& x : made.cloth.positions)
        x += 2e-3 * random.point();
    made.settings.radius = 0.02;
    return made;
}

} // namespace toile::test
