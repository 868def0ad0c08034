#include "scenes/world/world_crossings.h"

#include "collision/check/find_crossings.h"

namespace toile::scenes {

int crossing_count(const World& world)
{
    std::vector<Triangle> triangles;
    std::vector<Vec3> x;
    for (const ClothState& surface : world.simulated()) {
        for (const Triangle& t : surface.triangles)
            triangles.push_back(t + Triangle::Constant(int(x.size())));
        x.insert(x.end(), surface.positions.begin(), surface.positions.end());
    }
    return int(collision::find_crossings(triangles, x).size());
}

} // namespace toile::scenes
