#include <gtest/gtest.h>

#include "scenes/format/field.h"
#include "scenes/format/read_scene.h"
#include "scenes/world.h"

/// Every global solver that a scene can name does the same work: with tight tolerances the cloth ends where
/// the direct solver puts it.
namespace toile {
namespace {

/// Positions of a sheet that swings from one edge, after three samples.
std::vector<Vec3> swing(const std::string& method)
{
    World world(parse_scene(R"({"toile": 1, "frames": 4,
        "cloths": [{"name": "sheet", "rectangle": {"size": [0.4, 0.3], "resolution": 0.03}}],
        "attachments": [{"cloth": "sheet", "select": {"box": {"lower": [-0.3, -1, -1], "upper": [-0.19, 1, 1]}}, "to": "fixed"}],
        "solver": {"method": ")" +
                                method + R"(", "tolerance": 1e-6, "max_iterations": 400}})",
                            "swing.json"));
    while (world.frame() < 3)
        world.advance_frame();
    return world.cloths()[0].positions;
}

class SolverMethods : public testing::TestWithParam<std::string> {};

TEST_P(SolverMethods, PutTheClothWhereTheDirectSolverDoes)
{
    static const std::vector<Vec3> direct = swing("direct");
    const std::vector<Vec3> found = swing(GetParam());
    double farthest = 0.0, drop = 0.0;
    for (size_t v = 0; v < direct.size(); ++v) {
        farthest = std::max(farthest, (found[v] - direct[v]).norm());
        drop = std::max(drop, -direct[v].y());
    }
    EXPECT_GT(drop, 0.02);
    EXPECT_LT(farthest, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Scene, SolverMethods,
                         testing::ValuesIn(scene_format::words_of<scene::SolverMethod>()),
                         [](const auto& method) {
                             std::string name = method.param;
                             std::erase(name, '-');
                             return name;
                         });

} // namespace
} // namespace toile
