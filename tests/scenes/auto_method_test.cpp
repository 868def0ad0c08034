#include <gtest/gtest.h>

#include "core/quadrature/tables/table_store.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"

/// Cost of "auto" in scenes; for its decisions see tests/core/quadrature/auto_solver_test.cpp.
namespace toile::test {

using namespace scenes;

namespace {

/// Square sheet that swings from one edge, (side / resolution + 1)^2 vertices.
World swinging(const std::string& method, double resolution, int threads = 0)
{
    WorldOptions options;
    options.tables = std::make_shared<TableStore>();
    return World(parse_scene(R"({"toile": 1, "frames": 100, "solver": {"method": ")" + method +
                                 R"(", "quality": "preview", "threads": )" + std::to_string(threads) +
                                 R"(}, "cloths": [{"name": "sheet", "rectangle": {"size": [0.72, 0.72],
            "resolution": )" + std::to_string(resolution) +
                                 R"(}}], "attachments": [{"cloth": "sheet", "release": 0.05,
            "select": {"box": {"lower": [-0.37, -1, -1], "upper": [-0.35, 1, 1]}}}]})",
                             "test.json"),
                 options);
}

TEST(AutoMethod, IsTheDirectOneOnSmallClothAndCostsNothing)
{
    World automatic = swinging("auto", 0.04, 2), direct = swinging("direct", 0.04, 2);
    while (automatic.stages().calls("linear/solve") < 200 && automatic.frame() < 90) {
        automatic.advance_frame();
        direct.advance_frame();
    }
    EXPECT_EQ(automatic.cloths()[0].positions, direct.cloths()[0].positions);
    EXPECT_GE(automatic.stages().calls("linear/solve"), 200) << "as many as larger cloth rehearses after";
    EXPECT_EQ(automatic.stages().calls("auto/prepare"), 2) << "held, and let go";
    for (const char* stage : {"auto/rehearse", "auto/search", "auto/begin", "auto/switch", "auto/fail"})
        EXPECT_EQ(automatic.stages().calls(stage), 0) << stage;
}

/// Number of rehearsals with 5 329 vertices, after enough solves.
long rehearsals_on_threads(int threads)
{
    World world = swinging("auto", 0.01, threads);
    while (world.stages().calls("linear/solve") < 300 && world.frame() < 60)
        world.advance_frame();
    EXPECT_GE(world.stages().calls("linear/solve"), 300);
    return world.stages().calls("auto/rehearse");
}

TEST(AutoMethod, RehearsesLargerClothUnlessItHasOneThread)
{
    EXPECT_EQ(rehearsals_on_threads(1), 0);
    EXPECT_GE(rehearsals_on_threads(2), 1);
}

} // namespace
} // namespace toile::test
