#pragma once

/// Folded cloth with wanted motions, for tests that keep cloth from crossing cloth.

#include "tests/collision/soups.h"

namespace toile::test {

struct ClothCase {
    std::vector<Triangle> triangles;
    std::vector<Vec3> x, expected, wanted; ///< [vertices] [m]
    std::vector<double> slack;             ///< [vertices] [m]
};

/// Cloth in flight. Random sizes: the jitter of each vertex, the deviation of some vertices from the expected
/// motion, and the sliding of the layers. Layers meet in some cases and not in others.
inline ClothCase random_cloth_case(Random& random)
{
    const Soup soup = folded_sheet(random);
    ClothCase made{soup.triangles, soup.x, soup.x, soup.x, std::vector<double>(soup.x.size(), 3e-4)};
    const Vec3 flight = 0.05 * random.point();
    const double shake = random.scale(1e-6, 1e-3), deviation = random.scale(1e-5, 3e-3);
    const double slide = random.below(3) == 0 ? 0.005 : 0.0;
    for (size_t v = 0; v < made.x.size(); ++v) {
        made.expected[v] += flight + shake * random.point();
        made.wanted[v] = made.expected[v] + shake * random.point();
        if (random.below(20) == 0)
            made.wanted[v] += deviation * random.point();
        made.wanted[v].z() += slide * std::floor(made.x[v].y() / 0.003);
    }
    return made;
}

} // namespace toile::test
