#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"

namespace toile::scenes {
namespace {

/// Difference of the largest and smallest distance from the axis along the hem [m], after a second.
double spread_of_hem(const std::string& fabric)
{
    const Scene scene = parse_scene(R"({"toile": 1, "frames": 31,
        "cloths": [{"name": "skirt", "skirt": {"waist_radius": 0.155, "hem_radius": 0.3, "length": 0.5,
            "resolution": 0.02}, "translate": [0, 1, 0], "fabric": ")" +
                                        fabric + R"("}],
        "attachments": [{"cloth": "skirt", "select": {"box": {"lower": [-1, 0.99, -1], "upper": [1, 1.1, 1]}}}]})",
                                    "folding.json");
    World world(scene);
    double start = 0.0;
    for (const Vec3& p : world.cloths()[0].positions)
        start = std::min(start, p.y() - 1.0);
    std::vector<int> hem;
    for (int i = 0; i < int(world.cloths()[0].positions.size()); ++i)
        if (world.cloths()[0].positions[i].y() - 1.0 < start + 1e-6)
            hem.push_back(i);
    while (world.frame() + 1 < scene.frames)
        EXPECT_EQ(world.advance_frame().status, StepReport::Status::Converged);
    double nearest = 1e9, farthest = 0.0;
    for (const int i : hem) {
        const Vec3& p = world.cloths()[0].positions[i];
        const double radius = std::hypot(p.x(), p.z());
        nearest = std::min(nearest, radius);
        farthest = std::max(farthest, radius);
    }
    return farthest - nearest;
}

/// A cone in perfect symmetry would hang like a lampshade.
TEST(Folding, OfASkirtFormsAtItsHem)
{
    for (const char* fabric : {"silk", "cotton"})
        EXPECT_GT(spread_of_hem(fabric), 0.02) << fabric;
}

} // namespace
} // namespace toile::scenes
