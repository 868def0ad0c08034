#pragma once

/// Moving triangle soups, for searches of near pairs.

#include <cmath>
#include <vector>

#include "collision/geometry/trajectories.h"
#include "tests/collision/pair_cases.h"

namespace toile::test {

using namespace collision;

struct Soup {
    std::vector<Triangle> triangles;
    std::vector<Vec3> x;
    std::vector<Vec3> motion;
    std::vector<double> slack;

    Trajectories trajectories() const { return {motion, slack}; }
    void stand_still()
    {
        motion.assign(x.size(), Vec3::Zero());
        slack.assign(x.size(), 0.0);
    }
};

/// Adds a grid in the plane y = `height`, side x side vertices, `edge` [m] apart.
inline void add_sheet(Soup& soup, int side, double edge, double height)
{
    const int first = int(soup.x.size());
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i)
            soup.x.emplace_back(edge * i, height, edge * j);
    for (int j = 0; j + 1 < side; ++j)
        for (int i = 0; i + 1 < side; ++i) {
            const int a = first + j * side + i, b = a + 1, c = a + side, d = c + 1;
            soup.triangles.emplace_back(a, c, b);
            soup.triangles.emplace_back(b, c, d);
        }
    soup.stand_still();
}

/// Unconnected and shared corners, some triangles collapsed, some repeated.
inline Soup random_soup(Random& random)
{
    Soup soup;
    for (int i = 0; i < 120; ++i) {
        soup.x.push_back(random.point());
        soup.motion.push_back(0.05 * random.point() + Vec3(0, -30, 0));
        soup.slack.push_back(random.below(3) == 0 ? 0.02 * random.uniform(0, 1) : 0.0);
    }
    for (int t = 0; t < 150; ++t) {
        const int a = random.below(110), b = a + 1 + random.below(8), c = random.below(118);
        soup.triangles.emplace_back(a, b, random.below(20) == 0 ? a : c);
    }
    return soup;
}

/// Sheet folded in zigzag with close layers, each vertex moving independently on top of a common fall.
inline Soup folded_sheet(Random& random)
{
    Soup soup;
    add_sheet(soup, 24, 0.01, 0.0);
    soup.motion.clear();
    soup.slack.clear();
    for (Vec3& x : soup.x) {
        const double fold = x.x() / 0.06;
        const double layer = std::floor(fold), along = fold - layer;
        x.x() = 0.06 * (int(layer) % 2 == 0 ? along : 1.0 - along);
        x.y() = 0.003 * layer + 0.003 * along * along + 1e-4 * random.uniform(-1, 1);
        soup.motion.push_back(random.scale(1e-5, 5e-3) * random.point() + Vec3(0, -1, 0));
        soup.slack.push_back(random.below(3) == 0 ? 1e-3 * random.uniform(0, 1) : 0.0);
    }
    return soup;
}

} // namespace toile::test
