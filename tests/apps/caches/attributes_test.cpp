#include <gmock/gmock.h>

#include "apps/toile/caches/cache_contents.h"
#include "core/base/stages.h"
#include "export/alembic/abc_reader.h"
#include "export/byte_order.h"
#include "scenes/colliders/scene_body.h"
#include "scenes/format/read_scene.h"
#include "scenes/surfaces/load_cloth.h"
#include "tests/apps/program.h"

namespace toile::test {

using namespace exports;

namespace {

using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::FloatNear;
using testing::HasSubstr;
using testing::SizeIs;

/// A sheet of two panels and a vertex without a face, which is held 1 cm above a box. Within a second it is
/// stretched by 10 %, and the box sinks by 5 cm. A ball falls beside them.
class AttributesOfExportsTest : public FileTest {
protected:
    static constexpr int kFrames = 11;

    std::string scene(const std::string& exports) const
    {
        temporary_.write("sheet.obj", "v -0.1 0.21 0.1\nv 0.1 0.21 0.1\nv 0 0.5 0\nv 0.1 0.21 -0.1\n"
                                      "v -0.1 0.21 -0.1\ng left\nf 1 2 4\ng right\nf 1 4 5\n");
        return R"({"toile": 1, "frames": 11, "fps": 10,
            "avatars": [{"name": "floor", "plane": {}, "translate": [0, -1, 0]},
                        {"name": "block", "box": {"size": [1, 0.2, 1]}, "translate": [0, 0.1, 0],
                         "keyframes": [{"time": 0}, {"time": 1, "translate": [0, -0.05, 0]}]}],
            "cloths": [{"name": "sheet", "file": "sheet.obj"}],
            "solids": [{"name": "die", "box": {"size": [0.1, 0.1, 0.1]}, "translate": [3, 5, 0]}],
            "attachments": [
                {"cloth": "sheet", "select": {"box": {"lower": [-1, 0, -1], "upper": [-0.01, 0.3, 1]}}},
                {"cloth": "sheet", "select": {"box": {"lower": [0.01, 0, -1], "upper": [1, 0.3, 1]}},
                 "keyframes": [{"time": 0}, {"time": 1, "translate": [0.02, 0, 0]}]}],
            "export": )" +
               exports + "}";
    }
    Finished simulate(const std::string& exports, std::vector<std::string> options = {}) const
    {
        temporary_.write("scene.json", scene(exports));
        std::vector<std::string> arguments{"simulate", "scene.json", "-o", "out", "--quiet", "--no-check"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return run_toile(arguments, folder_);
    }
    void simulate_well(const std::string& exports, const std::vector<std::string>& options = {}) const
    {
        const Finished run = simulate(exports, options);
        EXPECT_EQ(run.exit_code, 0) << run.errors;
    }

    /// Attribute of a mesh of an archive; none if it has none.
    template <typename T>
    static std::optional<std::vector<T>> attribute(const AbcReader& reader, const std::string& mesh,
                                                   const std::string& name, int sample = 0)
    {
        for (size_t k = 0; k < reader.objects().size(); ++k)
            if (reader.path_of(int(k)) == mesh)
                if (const auto property =
                        reader.find(reader.objects()[k].properties, {".geom", ".arbGeomParams", name}))
                    return values_of<T>(reader.sample(*property, sample));
        return std::nullopt;
    }
    static std::vector<float> floats(const AbcReader& reader, const std::string& mesh,
                                     const std::string& name, int sample)
    {
        return attribute<float>(reader, mesh, name, sample).value();
    }
    static float strain_at(int frame) { return 0.01f * float(frame); }
    static float gap_at(int frame) { return 0.01f + 0.005f * float(frame); }
};

TEST_F(AttributesOfExportsTest, AreTheStrainAndTheGapOfTheirSample)
{
    simulate_well(R"([{"file": "a.abc", "avatars": true, "attributes": ["gap", "strain", "panel"]}])");
    const AbcReader reader(file("out/a.abc"));
    for (int frame = 0; frame < kFrames; ++frame) {
        EXPECT_THAT(floats(reader, "/sheet/sheetShape", "strain", frame),
                    AllOf(SizeIs(5), Each(FloatNear(strain_at(frame), 2e-6f))));
        const std::vector<float> gap = floats(reader, "/sheet/sheetShape", "gap", frame);
        EXPECT_THAT(gap, AllOf(SizeIs(5), Each(FloatNear(gap_at(frame), 1e-6f))));
    }
    EXPECT_THAT(*attribute<std::int32_t>(reader, "/sheet/sheetShape", "panel"), ElementsAre(0, 1));
    for (const char* other : {"/block/blockShape", "/floor/floorShape", "/die/dieShape"})
        for (const char* name : {"strain", "gap", "panel"})
            EXPECT_FALSE(attribute<float>(reader, other, name).has_value()) << other;
}

TEST_F(AttributesOfExportsTest, FollowTheVerticesToBothSidesAndIntoPanels)
{
    simulate_well(R"([{"file": "closed.abc", "cloth": "sheet", "thickness": true,
                       "attributes": ["strain", "panel"]},
                      {"file": "panels.abc", "cloth": "sheet", "weld": false, "subframes": 2, "unit": "cm",
                       "attributes": ["gap", "panel"]}])");
    const AbcReader closed(file("out/closed.abc")), panels(file("out/panels.abc"));
    EXPECT_THAT(floats(closed, "/sheet/sheetShape", "strain", 10),
                AllOf(SizeIs(10), Each(FloatNear(0.1f, 2e-6f))));
    EXPECT_THAT(*attribute<std::int32_t>(closed, "/sheet/sheetShape", "panel"),
                ElementsAre(0, 1, 2, 2, 2, 2, 0, 1))
        << "the rim is a group of its own";
    for (const auto& [mesh, number] :
         {std::pair("/sheet/left/leftShape", 0), {"/sheet/right/rightShape", 1}}) {
        EXPECT_THAT(floats(panels, mesh, "gap", 20), AllOf(SizeIs(3), Each(FloatNear(6.0f, 1e-4f)))) << "cm";
        EXPECT_THAT(floats(panels, mesh, "gap", 5), Each(FloatNear(2.25f, 1e-4f))) << "between frames";
        EXPECT_THAT(*attribute<std::int32_t>(panels, mesh, "panel"), ElementsAre(number));
    }
}

TEST_F(AttributesOfExportsTest, AreChosenByAnOptionToo)
{
    simulate_well("[]", {"--export", "a.ply", "--export-cloth", "sheet", "--attributes", "gap,strain"});
    const std::string ply = bytes_of(file("out/a_0010.ply"));
    EXPECT_THAT(ply, HasSubstr("property float gap\nproperty float strain\nelement face"));
    const Finished unknown = simulate("[]", {"--export", "a.abc", "--attributes", "stress"});
    EXPECT_EQ(unknown.exit_code, 2);
    EXPECT_THAT(unknown.errors, HasSubstr("--attributes: stress not in {strain,gap,panel}"));
    const Finished alone = simulate("[]", {"--attributes", "strain"});
    EXPECT_EQ(alone.exit_code, 2);
    EXPECT_THAT(alone.errors, HasSubstr("--attributes requires --export"));
}

TEST_F(AttributesOfExportsTest, AreOfCloths)
{
    const Finished solid = simulate(R"([{"file": "a.abc", "cloth": "die", "attributes": ["strain"]}])");
    EXPECT_EQ(solid.exit_code, 2);
    EXPECT_THAT(solid.errors,
                HasSubstr("scene.json: export[0].attributes: are of cloths, and the entry writes "
                          "none; leave them out, or add a cloth to \"cloth\""));
    EXPECT_FALSE(std::filesystem::exists(file("out")));
}

TEST_F(AttributesOfExportsTest, CostNothingWhereThereAreNone)
{
    const auto calls = [&](const std::string& attributes) {
        const scenes::Scene scene = scenes::parse_scene(
            this->scene(R"([{"file": "a.abc", "attributes": [)" + attributes + "]}]"), file("scene.json"));
        const std::vector<scenes::ClothState> surfaces = scenes::load_surfaces(scene);
        const std::vector<scenes::SceneBody> bodies = scenes::make_bodies(scene);
        std::vector<std::pair<std::string, const TriangleMesh*>> avatars;
        std::vector<std::vector<Vec3>> positions;
        for (const scenes::SceneBody& body : bodies) {
            avatars.emplace_back(body.settings().name, &body.surface());
            positions.push_back(body.surface().positions);
        }
        app::CacheContents contents(scene.exports[0], scene, surfaces, avatars);
        Stages stages;
        const Stages::Activate here(stages);
        for (int k = 0; k < 3; ++k)
            static_cast<void>(contents.sample(
                [&](int surface) { return View<const Vec3>(surfaces[size_t(surface)].positions); },
                positions));
        return std::pair(stages.calls("maps/strain"), stages.calls("maps/gap"));
    };
    EXPECT_EQ(calls(""), std::pair(0L, 0L));
    EXPECT_EQ(calls("\"panel\""), std::pair(0L, 0L));
    EXPECT_EQ(calls("\"strain\""), std::pair(3L, 0L));
    EXPECT_EQ(calls("\"panel\", \"gap\""), std::pair(0L, 3L));
}

} // namespace
} // namespace toile::test
