#include "core/base/error.h"
#include "scenes/format/read_scene.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scenes/format/scene_fabric.h"
#include "scenes/format/validate.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

using namespace garment;
using namespace scenes;

namespace {

TEST(ReadScene, GivesTheDocumentedDefaultsToAMinimalScene)
{
    const Scene scene = parse_scene(R"({"toile": 1, "frames": 3, "cloths": [{"name": "a", "disc": {}}]})",
                                    "folder/small.json");
    EXPECT_EQ(scene.name, "small");
    EXPECT_EQ(scene.frames, 3);
    EXPECT_EQ(scene.fps, 30.0);
    EXPECT_DOUBLE_EQ(scene.frame_duration(), 1.0 / 30.0);
    EXPECT_EQ(scene.gravity, Vec3(0.0, -9.81, 0.0));
    EXPECT_FALSE(scene.solver.substeps.has_value());
    EXPECT_EQ(scene.solver.quality, scene::Quality::Standard);
    EXPECT_FALSE(scene.solver.tolerance.has_value());
    EXPECT_EQ(scene.solver.stop, StepStop::Error);
    EXPECT_TRUE(scene.avatars.empty());
    EXPECT_EQ(scene.render.ground, 0.0);
    EXPECT_EQ(std::get<scene::Disc>(scene.cloths.at(0).shape).radius, 0.5);
    EXPECT_EQ(scene.cloths[0].fabric, "cotton");
    EXPECT_FALSE(scene.cloths[0].thickness.has_value());
}

TEST(ReadScene, AcceptsTheFormerNameOfPrintWithAWarning)
{
    const auto scene_with = [](const std::string& key) {
        return parse_scene(R"({"toile": 1, "frames": 1, "cloths": [{"name": "c", "disc": {}, )" + key + "}]}",
                           "old.json");
    };
    const Scene old = scene_with(R"("pattern": "checker")");
    EXPECT_EQ(old.cloths[0].print, scene::Print::Checker);
    EXPECT_EQ(former_key_warnings_of(old),
              std::vector<std::string>{
                  "old.json: cloths[0].pattern is the former name of print; write \"print\": \"checker\""});
    EXPECT_TRUE(former_key_warnings_of(scene_with(R"("print": "checker")")).empty());
    EXPECT_NO_THROW(require_valid(old));
    EXPECT_THROW(scene_with(R"("pattern": "checker", "print": "stripes")"), InvalidInput);
}

/// Files of motions and of their maps are looked for beside the scene.
TEST(ReadScene, FindsMotionsAndMapsBesideTheScene)
{
    const std::filesystem::path folder = process_folder() / "toile_motions";
    std::filesystem::create_directories(folder);
    for (const char* name : {"walk.bvh", "map.json"})
        std::ofstream(folder / name) << "-";
    const auto read = [&](const std::string& map) {
        return parse_scene(R"({"toile": 1, "frames": 1, "cloths": [{"name": "c", "disc": {}}],
            "avatars": [{"name": "a", "mannequin": {}, "start": 0.5,
                         "motion": {"file": "walk.bvh", "clip": "w", "map": ")" +
                               map + R"("}}]})",
                           folder / "scene.json")
            .avatars[0];
    };
    const scene::Avatar avatar = read("map.json");
    ASSERT_TRUE(avatar.motion);
    EXPECT_EQ(avatar.motion->file, folder / "walk.bvh");
    EXPECT_EQ(avatar.motion->clip, "w");
    EXPECT_EQ(avatar.motion->map, (folder / "map.json").string());
    EXPECT_EQ(read("cmu").motion->map, "cmu");
}

TEST(ReadScene, ReadsEveryKindOfValue)
{
    const Scene scene = parse_scene(R"({
        "toile": 1, "frames": 10.0, "fps": 25, "settle": 0.5,
        "avatars": [
            {"name": "ball", "sphere": {"radius": 0.2}, "friction": 0.7,
             "keyframes": [{"time": 0}, {"time": 1.5, "translate": [0, 1, 0], "rotate_deg": [0, 90, 0]}]},
            {"name": "figure", "mannequin": {"height": 1.6}, "clip": "walk", "loop": true,
             "preroll": {"hold": 0.25, "ease": 1, "from_bind": true}}],
        "cloths": [
            {"name": "sheet", "rectangle": {"size": [1, 2], "resolution": 0.1}, "grain_deg": 45,
             "subdivide": 1, "print": "stripes", "fabric": "felt", "thickness": 0.002},
            {"name": "round", "disc": {"radius": 0.3}, "scale": 2}],
        "fabrics": {"felt": {"base": "wool", "areal_density": 0.3, "stretch": {"warp": 500},
                             "bend": {"weft": 0}, "strain_limit": 1.06}},
        "attachments": [
            {"cloth": "sheet", "select": {"vertices": [0, 3]}, "keyframes": [{"time": 2, "translate": [1, 0, 0]}]},
            {"cloth": "sheet", "select": {"nearest": [[0, 1, 0], [1, 1, 1]]}, "to": "ball", "release": 0.5},
            {"cloth": "round", "select": {"all_within": {"avatar": "figure", "distance": 0.01}},
             "to": "figure", "stiffness": 100}],
        "solver": {"method": "direct", "stop": "move", "sleep": {"enabled": false}},
        "export": [{"file": "sheet.mdd", "cloth": "sheet"}],
        "render": {"ground": "off", "width": 320}})",
                                    "all.json");
    EXPECT_EQ(scene.frames, 10);
    EXPECT_EQ(scene.avatars[0].keyframes[1].rotate_deg, Vec3(0.0, 90.0, 0.0));
    EXPECT_EQ(scene.avatars[0].friction, 0.7);
    EXPECT_EQ(std::get<scene::Mannequin>(scene.avatars[1].shape).height, 1.6);
    EXPECT_TRUE(scene.avatars[1].preroll.from_bind);
    EXPECT_EQ(std::get<scene::Rectangle>(scene.cloths[0].shape).size, Vec2(1.0, 2.0));
    EXPECT_EQ(scene.cloths[0].print, scene::Print::Stripes);
    EXPECT_EQ(std::get<std::vector<int>>(scene.attachments[0].select.by), (std::vector<int>{0, 3}));
    EXPECT_EQ(scene.attachments[0].to, "fixed");
    EXPECT_EQ(std::get<std::vector<Vec3>>(scene.attachments[1].select.by).at(1), Vec3(1.0, 1.0, 1.0));
    EXPECT_EQ(scene.attachments[1].release, 0.5);
    EXPECT_EQ(std::get<scene::SelectNearAvatar>(scene.attachments[2].select.by).distance, 0.01);
    EXPECT_EQ(scene.attachments[2].stiffness, 100.0);
    EXPECT_EQ(scene.solver.method, scene::SolverMethod::Direct);
    EXPECT_EQ(scene.solver.stop, StepStop::Move);
    EXPECT_FALSE(scene.solver.sleep.enabled);
    EXPECT_EQ(scene.exports[0].file, "sheet.mdd");
    EXPECT_FALSE(scene.render.ground.has_value());
}

TEST(ReadScene, MergesAFabricFromPresetSceneAndCloth)
{
    const Scene scene = parse_scene(R"({"toile": 1, "frames": 1,
        "cloths": [{"name": "a", "disc": {}, "fabric": "felt", "thickness": 0.002}],
        "fabrics": {"felt": {"base": "wool", "stretch": {"warp": 500}, "bend": {"weft": 0},
                             "strain_limit": 1.25}}})",
                                    "felt.json");
    const Fabric fabric = scenes::fabric_of(scene, scene.cloths[0]);
    const Fabric& wool = fabric_preset("wool", "test");
    EXPECT_EQ(fabric.stretch_warp, 500.0);
    EXPECT_EQ(fabric.stretch_weft, wool.stretch_weft);
    EXPECT_EQ(fabric.bend_weft, 0.0);
    EXPECT_EQ(fabric.bend_warp, wool.bend_warp);
    EXPECT_EQ(fabric.thickness, 0.002);
    EXPECT_EQ(fabric.strain_limit, 0.25);
    EXPECT_EQ(fabric.areal_density, wool.areal_density);
}

TEST(ReadScene, ReadsTheUnitsOfLength)
{
    EXPECT_EQ(scene::metres_per(scene::LengthUnit::Metre), 1.0);
    EXPECT_EQ(scene::metres_per(scene::LengthUnit::Centimetre), 0.01);
    EXPECT_EQ(scene::metres_per(scene::LengthUnit::Millimetre), 0.001);
    EXPECT_EQ(scene::metres_per(scene::LengthUnit::Inch), 0.0254);
}

} // namespace
} // namespace toile::test
