#include <cmath>

#include <gtest/gtest.h>

#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"

namespace toile::test {

using namespace scenes;

namespace {

/// A sheet of lead, 5 kg, and far from it one of silk, 0.5 g, each hung up by a corner.
World lead_and_silk(const std::string& tolerance)
{
    return World(parse_scene(R"({"toile": 1, "fps": 60, "frames": 5, "solver": {"velocity_tolerance": )" +
                                 tolerance +
                                 R"(},
        "fabrics": {"lead": {"areal_density": 5.0}, "silk": {"areal_density": 0.05}},
        "cloths": [
          {"name": "lead", "fabric": "lead", "rectangle": {"size": [1, 1], "resolution": 0.1},
           "translate": [0, 2, 0]},
          {"name": "silk", "fabric": "silk", "rectangle": {"size": [0.1, 0.1], "resolution": 0.025},
           "translate": [3, 2, 0]}],
        "attachments": [{"cloth": "lead", "select": {"nearest": [[-0.5, 2, -0.5]]}},
                        {"cloth": "silk", "select": {"nearest": [[2.95, 2, -0.05]]}}]})",
                             "test.json"));
}

TEST(UnequalCloths, AreSolvedToTheSameTolerance)
{
    World coarse = lead_and_silk("1e-3"), exact = lead_and_silk("1e-6");
    for (int frame = 0; frame < 5; ++frame) {
        coarse.advance_frame();
        exact.advance_frame();
    }
    for (int s = 0; s < 2; ++s) {
        const std::vector<Vec3>&a = coarse.surfaces()[s].positions, &b = exact.surfaces()[s].positions;
        double square = 0.0;
        for (size_t v = 0; v < a.size(); ++v)
            square += (a[v] - b[v]).squaredNorm() / double(a.size());
        EXPECT_LT(std::sqrt(square), 2.0 * 1e-3 * 5 / 60.0) << s;
    }
}

} // namespace
} // namespace toile::test
