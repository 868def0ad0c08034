#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "research/scenes/literature_methods.h"
#include "scenes/format/field.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

/// Equivalence of all methods that a scene can name: with tight tolerances the cloth ends where the direct
/// solver puts it. Unsupported features are refused.
namespace toile::test {

using namespace collision;
using namespace research;
using namespace scenes;

namespace {

World world_of(const std::string& json, const std::string& solver)
{
    static const LiteratureMethods baselines;
    WorldOptions options;
    options.baselines = &baselines;
    return World(parse_scene(R"({"toile": 1, "frames": 100, "solver": {"integrator": "implicit-euler", )" +
                                 solver + "}, " + json + "}",
                             "scene.json"),
                 options);
}

std::vector<Vec3> positions_after(World& world, int samples)
{
    while (world.frame() < samples)
        EXPECT_NE(world.advance_frame().status, StepReport::Status::NonFinite);
    return world.cloths()[0].positions;
}

double max_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double max = 0.0;
    for (size_t v = 0; v < a.size(); ++v)
        max = std::max(max, (a[v] - b[v]).norm());
    return max;
}

double lowest(const std::vector<Vec3>& x)
{
    double y = x[0].y();
    for (const Vec3& p : x)
        y = std::min(y, p.y());
    return y;
}

constexpr const char* kFreeSheet =
    R"("cloths": [{"name": "sheet", "rectangle": {"size": [0.4, 0.3], "resolution": 0.03}}])";

/// Sheet that swings from one edge.
constexpr const char* kSwing =
    R"("cloths": [{"name": "sheet", "rectangle": {"size": [0.4, 0.3], "resolution": 0.03}}],
       "attachments": [{"cloth": "sheet", "select": {"box": {"lower": [-0.3, -1, -1], "upper": [-0.19, 1, 1]}}, "to": "fixed"}])";

std::vector<Vec3> swing(const std::string& solver)
{
    World world = world_of(kSwing, solver);
    return positions_after(world, 3);
}

const std::vector<Vec3>& swing_of_direct()
{
    static const std::vector<Vec3> x =
        swing(R"("method": "direct", "tolerance": 1e-6, "max_iterations": 400)");
    return x;
}

/// Name of a test for a word of the scene format.
std::string to_name(std::string word)
{
    std::replace(word.begin(), word.end(), '-', '_');
    return word;
}

class SolverMethods : public testing::TestWithParam<const char*> {};

TEST_P(SolverMethods, PutTheClothWhereTheDirectSolverDoes)
{
    const std::vector<Vec3> found =
        swing(R"("substeps": 4, "tolerance": 1e-6, "max_iterations": 400, "method": ")" +
              std::string(GetParam()) + '"');
    EXPECT_LT(lowest(swing_of_direct()), -0.02);
    EXPECT_LT(max_distance(found, swing_of_direct()), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Scene, SolverMethods,
                         testing::Values("auto", "quadrature", "multigrid", "subspace", "chebyshev",
                                         "a-jacobi", "jacobi-pcg", "vbd"),
                         [](const auto& method) { return to_name(method.param); });

class OuterMethods : public testing::TestWithParam<std::string> {};

TEST_P(OuterMethods, PutTheClothWhereLbfgsDoes)
{
    const std::vector<Vec3> found =
        swing(R"("substeps": 4, "tolerance": 1e-6, "max_iterations": 400, "outer": ")" + GetParam() + '"');
    EXPECT_LT(max_distance(found, swing_of_direct()), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Scene, OuterMethods, testing::ValuesIn(scene_format::words_of<OuterMethod>()),
                         [](const auto& method) { return to_name(method.param); });

/// The steps end sooner, so the key reaches them.
TEST(StopByMove, TakesFewerIterations)
{
    const auto iterations = [](const std::string& stop) {
        World world = world_of(kSwing, R"("outer": "lbfgs", "tolerance": 1e-4, "stop": ")" + stop + '"');
        int sum = 0;
        for (int frame = 0; frame < 3; ++frame)
            sum += world.advance_frame().iterations;
        return sum;
    };
    const int by_move = iterations("move");
    EXPECT_GT(by_move, 0);
    EXPECT_LT(by_move, iterations("error"));
}

/// XPBD does not solve the implicit time step: its motion with many substeps is that of small steps.
TEST(XpbdMethod, PutsTheClothWhereSmallStepsDo)
{
    const std::vector<Vec3> small =
        swing(R"("method": "direct", "substeps": 64, "tolerance": 1e-8, "max_iterations": 200)");
    const double few = max_distance(swing(R"("method": "xpbd", "max_iterations": 2)"), small);
    const double many =
        max_distance(swing(R"("method": "xpbd", "substeps": 16, "max_iterations": 10)"), small);
    EXPECT_LT(many, 1e-3);
    EXPECT_GT(few, 3.0 * many);
}

class BaselineMethods : public testing::TestWithParam<const char*> {
public:
    std::string with(const std::string& rest) const { return rest + R"(, "method": ")" + GetParam() + '"'; }
};
INSTANTIATE_TEST_SUITE_P(Scene, BaselineMethods, testing::Values("xpbd", "vbd"),
                         [](const auto& method) { return std::string(method.param); });

TEST_P(BaselineMethods, FactorNothing)
{
    World world = world_of(kSwing, with(R"("max_iterations": 5)"));
    const StepReport report = world.advance_frame();
    EXPECT_EQ(report.iterations, 20);
    EXPECT_EQ(world.stages().calls("linear/analyse"), 0);
    EXPECT_EQ(world.stages().calls("linear/factor"), 0);
    EXPECT_EQ(world.stages().calls("pd/minimise"), 0);
    EXPECT_GT(world.stages().calls("scenes/step"), 0);
}

TEST_P(BaselineMethods, IgnoreClothAgainstCloth)
{
    World world = world_of(kFreeSheet, with(R"("max_iterations": 5)"));
    (void)world.advance_frame();
    for (const char* stage :
         {"collision/near_pairs", "collision/collision_free_step", "scenes/find_crossings"})
        EXPECT_EQ(world.stages().calls(stage), 0) << stage;
}

TEST_P(BaselineMethods, RefuseSpringsByTheKey)
{
    const std::string spring = R"("cloths": [{"name": "sheet", "rectangle": {}}],
        "attachments": [{"cloth": "sheet", "select": {"vertices": [0]}, "stiffness": 10}])";
    const std::string message = refusal([&] { world_of(spring, with(R"("substeps": 4)")); });
    EXPECT_NE(message.find("scene.json: attachments[0].stiffness: solver.method \"" +
                           std::string(GetParam()) + "\" knows no springs"),
              std::string::npos)
        << message;
    EXPECT_NE(message.find("\"direct\""), std::string::npos) << message;
}

/// A sheet draped over a ball ends at the direct solver's result within a few edges (40 mm): folds may flip.
TEST_P(BaselineMethods, DrapeASheetOverABall)
{
    const std::string ball =
        R"("cloths": [{"name": "sheet", "disc": {"radius": 0.3, "resolution": 0.04}, "translate": [0, 0.21, 0]}],
        "avatars": [{"name": "ball", "sphere": {"radius": 0.2}}])";
    World world = world_of(ball, with(R"("substeps": 16, "max_iterations": 8)"));
    const std::vector<Vec3> x = positions_after(world, 30);
    World direct = world_of(ball, R"("substeps": 4)");
    const std::vector<Vec3> expected = positions_after(direct, 30);
    double nearest = 1.0;
    for (const Vec3& p : x)
        nearest = std::min(nearest, p.norm() - 0.2);
    EXPECT_GT(nearest, 0.0005);
    EXPECT_LT(lowest(x), 0.05);
    EXPECT_NEAR(lowest(x), lowest(expected), 0.03);
}

/// Cloth on a slope of 20 degrees, tan = 0.364, sticks or slides by g (sin - mu cos) t^2 / 2.
TEST_P(BaselineMethods, ObeyCoulombsLaw)
{
    const double slope = 20.0 * std::numbers::pi / 180.0, time = 12.0 / 30.0;
    for (const double friction : {0.5, 0.1}) {
        const std::string scene =
            R"("air": {"density": 0}, "fabrics": {"plain": {"damping": 0}}, "contact": {"friction": )" +
            std::to_string(friction) + R"(},
            "cloths": [{"name": "sheet", "fabric": "plain", "rectangle": {"size": [0.2, 0.2], "resolution": 0.05},
                        "rotate_deg": [0, 0, 20], "translate": [0, 0.0016, 0]}],
            "avatars": [{"name": "slope", "plane": {}, "rotate_deg": [0, 0, 20]}])";
        World world = world_of(scene, with(R"("max_iterations": 10)"));
        const Vec3 start = world.cloths()[0].positions[0];
        const Vec3 moved = positions_after(world, 12)[0] - start;
        const double slid = -moved.dot(Vec3(std::cos(slope), std::sin(slope), 0.0));
        const double expected =
            friction > std::tan(slope)
                ? 0.0
                : 0.5 * 9.81 * (std::sin(slope) - friction * std::cos(slope)) * time * time;
        EXPECT_NEAR(slid, expected, 0.002 + 0.05 * expected) << "friction " << friction;
    }
}

/// The paper's rule approximates no inverse of H that a step can use: its directions are refused and
/// reported.
TEST(PaperMethod, StopsWhenEveryDirectionIsRefused)
{
    World world = world_of(kSwing, R"("method": "paper", "quality": "preview")");
    const std::vector<Vec3> x = positions_after(world, 20);
    const StepReport report = world.advance_frame();
    EXPECT_EQ(report.status, StepReport::Status::IterationLimit);
    EXPECT_EQ(report.iterations, 0);
    EXPECT_LT(max_distance(world.cloths()[0].positions, x), 1e-3);
    EXPECT_LT(report.max_strain, 0.061);
}

TEST(PaperMethod, LetsFreeClothFall)
{
    World world = world_of(kFreeSheet, R"("method": "paper")");
    World direct = world_of(kFreeSheet, R"("method": "direct")");
    const std::vector<Vec3> expected = positions_after(direct, 5);
    EXPECT_LT(lowest(expected), -0.1);
    EXPECT_LT(max_distance(positions_after(world, 5), expected), 1e-3);
}

TEST(PaperMethod, RefusesClothThatIsNotFlat)
{
    const std::string message = refusal([] {
        world_of(R"("cloths": [{"name": "skirt", "skirt": {"resolution": 0.05}}])", R"("method": "paper")");
    });
    EXPECT_NE(message.find("cloth \"skirt\": its rest shape is not flat"), std::string::npos) << message;
    EXPECT_NE(message.find("choose \"auto\", \"direct\""), std::string::npos) << message;
}

} // namespace
} // namespace toile::test
