#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "collision/check/find_crossings.h"
#include "core/base/error.h"
#include "scenes/colliders/scene_body.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"

namespace toile::test {

using namespace collision;
using namespace scenes;

namespace {

using Kind = StartDefect::Kind;

Scene scene_of(const std::string& keys)
{
    return parse_scene("{\"toile\": 1, \"frames\": 3, " + keys + "}", "test.json");
}

/// Ball of 10 cm and a sheet at a height.
Scene ball_and_sheet(const std::string& height, const std::string& more = "")
{
    return scene_of(R"("avatars": [{"name": "ball", "sphere": {"radius": 0.1}}],
        "cloths": [{"name": "sheet", "rectangle": {"size": [0.3, 0.3], "resolution": 0.02},
                    "translate": [0, )" +
                    height + ", 0]}]" + more);
}

TEST(StartPose, IsOnlyCheckedInACleanScene)
{
    World world(ball_and_sheet("0.102"));
    EXPECT_EQ(world.stages().calls("scenes/start_check"), 1);
    EXPECT_EQ(world.stages().calls("scenes/start_repair"), 0);
    EXPECT_TRUE(world.start().defects.empty());
    EXPECT_EQ(world.start().vertices_too_near(), 0);
    EXPECT_EQ(world.cloths()[0].positions, world.cloths()[0].rest.positions);
    world.settle();
    EXPECT_EQ(world.stages().calls("scenes/relax_start"), 0);
}

/// Contact would throw cloth modelled at the height of its table up by 41 mm.
TEST(StartPose, IsMovedOffATableBeforeTheFirstStep)
{
    World world(scene_of(R"("contact": {"gap": 0.005}, "avatars": [{"name": "table", "plane": {}}],
        "cloths": [{"name": "sheet", "rectangle": {"size": [0.2, 0.2], "resolution": 0.02}}])"));
    EXPECT_EQ(world.start().vertices_too_near(), int(world.cloths()[0].positions.size()));
    EXPECT_FALSE(world.start().was_repaired);
    world.settle();
    for (;;) {
        for (const Vec3& p : world.cloths()[0].positions)
            EXPECT_NEAR(p.y(), 0.0051, 2e-4) << world.frame();
        if (world.frame() == 2)
            break;
        EXPECT_EQ(world.advance_frame().status, StepReport::Status::Converged);
    }
}

TEST(StartPose, IsRepairedBeforeTheFirstStepAndKeepsTheRestShape)
{
    World world(ball_and_sheet("0.085"));
    EXPECT_EQ(world.stages().calls("scenes/start_repair"), 1);
    EXPECT_TRUE(world.start().was_repaired);
    EXPECT_EQ(world.start().remaining(Kind::InsideBody), 0);
    for (const Vec3& p : world.cloths()[0].positions)
        EXPECT_GT(p.norm(), 0.1);
    for (const Vec3& p : world.cloths()[0].rest.positions)
        EXPECT_NEAR(p.y(), 0.085, 1e-12);

    // The solver starts there too.
    const std::vector<Vec3> start = world.cloths()[0].positions;
    const StepReport step = world.advance_frame();
    EXPECT_NE(step.status, StepReport::Status::NonFinite);
    for (size_t v = 0; v < start.size(); ++v)
        EXPECT_LT((world.cloths()[0].positions[v] - start[v]).norm(), 0.02) << v;
}

TEST(StartPose, IsUnchangedWhenRepairIsOff)
{
    World world(ball_and_sheet("0.085", R"(, "contact": {"repair_start": false})"));
    EXPECT_EQ(world.stages().calls("scenes/start_repair"), 0);
    EXPECT_FALSE(world.start().was_repaired);
    EXPECT_GT(world.start().count(Kind::InsideBody), 0);
    EXPECT_EQ(world.cloths()[0].positions, world.cloths()[0].rest.positions);
}

TEST(StartPose, IsRefusedWhereClothDoesNotFit)
{
    try {
        World world(ball_and_sheet("0.03"));
        ADD_FAILURE() << "accepted";
    } catch (const InvalidInput& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("test.json: cloth \"sheet\" does not fit its start pose"), std::string::npos)
            << message;
        EXPECT_NE(message.find("preroll"), std::string::npos) << message;
    }
    World world(ball_and_sheet("0.03", R"(, "contact": {"repair_start": false})"));
    EXPECT_FALSE(world.start().was_repaired);
}

TEST(StartPose, RelaxesWhatTheRepairHasStrained)
{
    // A tube on a ball that is a fifth too large for it.
    World world(scene_of(R"("fabrics": {"inextensible": {"base": "cotton", "strain_limit": 1.001}},
        "avatars": [{"name": "ball", "sphere": {"radius": 0.1}}],
        "cloths": [{"name": "sheet", "rectangle": {"size": [0.3, 0.3], "resolution": 0.02},
                    "translate": [0, 0.056, 0], "fabric": "inextensible"}])"));
    ASSERT_TRUE(world.start().was_repaired);
    const auto highest = [&] {
        double y = 0.0;
        for (const Vec3& p : world.cloths()[0].positions)
            y = std::max(y, p.y());
        return y;
    };
    const double before = highest();
    const std::vector<Vec3> repaired = world.cloths()[0].positions;
    world.settle();
    EXPECT_NE(world.cloths()[0].positions, repaired) << "it was not strained";
    EXPECT_GT(world.stages().calls("scenes/relax_start"), 0);
    EXPECT_NEAR(highest(), before, 0.005) << "it does not fall";
    EXPECT_LT(world.advance_frame().status, StepReport::Status::Yielded);
}

TEST(StartPose, RelaxesNothingThatIsNotStrained)
{
    World world(ball_and_sheet("0.085"));
    ASSERT_TRUE(world.start().was_repaired);
    world.settle();
    EXPECT_EQ(world.stages().calls("scenes/relax_start"), 0);
}

TEST(StartPose, PutsTheHigherLayerOnTop)
{
    // Tilted against each other, crossing along a line.
    World world(scene_of(R"("cloths": [
        {"name": "over", "layer": 1, "rectangle": {"size": [0.2, 0.2], "resolution": 0.02}, "rotate_deg": [0, 0, 6]},
        {"name": "under", "rectangle": {"size": [0.2, 0.2], "resolution": 0.02}, "rotate_deg": [0, 3, -6],
         "translate": [0.003, 0, 0.004]}])"));
    EXPECT_GT(world.start().count(Kind::Crossing), 0);
    EXPECT_EQ(world.start().remaining(Kind::Crossing), 0);
    for (const Vec3& over : world.cloths()[0].positions)
        for (const Vec3& under : world.cloths()[1].positions)
            if (std::hypot(over.x() - under.x(), over.z() - under.z()) < 0.004 && std::abs(over.x()) < 0.08) {
                EXPECT_GT(over.y(), under.y() - 0.001);
            }
}

/// Expected errors of the start and limits of the repaired pose for the five modelled garments.
struct Garment {
    const char* avatar;
    const char* name;
    int subdivide;
    int vertices_inside; ///< min at the start
    int crossings;       ///< min at the start
    double max_strain, rms_strain;
};

class ModelledGarment : public ::testing::TestWithParam<Garment> {};

TEST_P(ModelledGarment, StartsOnItsAvatarWithoutCrossings)
{
    const Garment& garment = GetParam();
    const std::filesystem::path data = TOILE_DATA_DIR;
    const std::string file = std::string("mh_") + garment.avatar + "_" + garment.name + ".obj";
    if (!std::filesystem::exists(data / "garments" / file))
        GTEST_SKIP() << "SKIPPED: TOILE_DATA_DIR has no garments/" << file;
    const Scene scene =
        scene_of(R"("avatars": [{"name": "body", "file": ")" +
                 (data / "avatars" / ("mh_" + std::string(garment.avatar) + ".glb")).string() +
                 R"("}], "cloths": [{"name": "garment", "file": ")" + (data / "garments" / file).string() +
                 "\", \"subdivide\": " + std::to_string(garment.subdivide) + "}]");
    const World world(scene);
    const StartReport& report = world.start();
    EXPECT_GE(report.vertices_inside(), garment.vertices_inside);
    EXPECT_GE(report.count(Kind::Crossing), garment.crossings);
    EXPECT_EQ(report.remaining(Kind::InsideBody), 0);
    EXPECT_EQ(report.remaining(Kind::Crossing), 0);
    EXPECT_LT(report.max_strain, garment.max_strain);
    EXPECT_LT(report.rms_strain, garment.rms_strain);
    const ClothState& cloth = world.cloths()[0];
    EXPECT_TRUE(find_crossings(cloth.triangles, cloth.positions).empty());

    // Tips of the body between the samples: dozens cross before the repair searches for them.
    const TriangleMesh body = SceneBody(scene.avatars[0]).surface();
    EXPECT_LT(find_crossings(cloth.triangles, cloth.positions, body.triangles, body.positions).size(), 20u);
}

INSTANTIATE_TEST_SUITE_P(Data, ModelledGarment,
                         ::testing::Values(Garment{"man", "male_casualsuit04", 0, 6, 0, 0.05, 0.005},
                                           Garment{"woman", "female_casualsuit01", 0, 325, 1, 0.5, 0.03},
                                           Garment{"woman", "female_elegantsuit01", 0, 75, 30, 0.3, 0.02},
                                           Garment{"woman", "skirt", 0, 7, 0, 0.05, 0.01},
                                           Garment{"woman", "tights", 0, 0, 0, 0.05, 0.005}),
                         [](const auto& instance) { return std::string(instance.param.name); });

} // namespace
} // namespace toile::test
