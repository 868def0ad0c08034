#include <gtest/gtest.h>

#include "scenes/format/field.h"
#include "scenes/format/read_scene.h"
#include "scenes/world.h"

/// Every global solver and every outer method that a scene can name does the same work: with tight tolerances
/// the cloth ends where the direct solver and L-BFGS put it.
namespace toile {
namespace {

/// Positions of a sheet that swings from one edge, after three samples.
/// @param solver  keys of the scene's solver
std::vector<Vec3> swing(const std::string& solver)
{
    World world(parse_scene(R"({"toile": 1, "frames": 4,
        "cloths": [{"name": "sheet", "rectangle": {"size": [0.4, 0.3], "resolution": 0.03}}],
        "attachments": [{"cloth": "sheet", "select": {"box": {"lower": [-0.3, -1, -1], "upper": [-0.19, 1, 1]}}, "to": "fixed"}],
        "solver": {)" + solver + R"(, "tolerance": 1e-6, "max_iterations": 400}})",
                            "swing.json"));
    while (world.frame() < 3)
        world.advance_frame();
    return world.cloths()[0].positions;
}

/// @param distance  largest allowed [m]
void expect_where_the_direct_solver_puts_it(const std::vector<Vec3>& found, double distance)
{
    static const std::vector<Vec3> direct = swing(R"("method": "direct")");
    double farthest = 0.0, drop = 0.0;
    for (size_t v = 0; v < direct.size(); ++v) {
        farthest = std::max(farthest, (found[v] - direct[v]).norm());
        drop = std::max(drop, -direct[v].y());
    }
    EXPECT_GT(drop, 0.02);
    EXPECT_LT(farthest, distance);
}

/// The word of a parameter as a test's name.
std::string to_name(std::string word)
{
    std::erase(word, '-');
    return word;
}

class SolverMethods : public testing::TestWithParam<std::string> {};

TEST_P(SolverMethods, PutTheClothWhereTheDirectSolverDoes)
{
    expect_where_the_direct_solver_puts_it(swing(R"("method": ")" + GetParam() + "\""), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Scene, SolverMethods,
                         testing::ValuesIn(scene_format::words_of<scene::SolverMethod>()),
                         [](const auto& method) { return to_name(method.param); });

class OuterMethods : public testing::TestWithParam<std::string> {};

TEST_P(OuterMethods, PutTheClothWhereLbfgsDoes)
{
    // The slow one's moves fall below the tolerance before it has arrived.
    const double distance = GetParam() == "local-global" ? 3e-3 : 1e-3;
    expect_where_the_direct_solver_puts_it(swing(R"("outer": ")" + GetParam() + "\""), distance);
}

INSTANTIATE_TEST_SUITE_P(Scene, OuterMethods, testing::ValuesIn(scene_format::words_of<OuterMethod>()),
                         [](const auto& method) { return to_name(method.param); });

} // namespace
} // namespace toile
