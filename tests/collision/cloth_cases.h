#pragma once

/// Folded cloth whose vertices want to go somewhere, for what keeps cloth from crossing cloth.

#include "tests/collision/soups.h"

namespace toile::test {

struct ClothCase {
    std::vector<Triangle> triangles;
    std::vector<Vec3> x, expected, wanted; ///< [vertices] [m]
    std::vector<double> slack;             ///< [vertices] [m]
};

/// All fly; how much each vertex shakes, how far some stray from what was expected, and how far the layers
/// slide on each other is chosen at random: with some layers meet, with some nothing does.
inline ClothCase random_cloth_case(Random& random)
{
    const Soup soup = folded_sheet(random);
    ClothCase made{soup.triangles, soup.x, soup.x, soup.x, std::vector<double>(soup.x.size(), 3e-4)};
    const Vec3 flight = 0.05 * random.point();
    const double shake = random.scale(1e-6, 1e-3), stray = random.scale(1e-5, 3e-3);
    const double slide = random.below(3) == 0 ? 0.005 : 0.0;
    for (size_t v = 0; v < made.x.size(); ++v) {
        made.expected[v] += flight + shake * random.point();
        made.wanted[v] = made.expected[v] + shake * random.point();
        if (random.below(20) == 0)
            made.wanted[v] += stray * random.point();
        made.wanted[v].z() += slide * std::floor(made.x[v].y() / 0.003);
    }
    return made;
}

} // namespace toile::test
