#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/mesh/obj.h"
#include "export/point_cache.h"
#include "tests/apps/program.h"
#include "tests/volume/blocks.h"
#include "volume/mesh/msh.h"

namespace toile::test {

using namespace exports;

namespace {

using Json = nlohmann::json;

/// A block that turns in the air, with a pyramid that has texture coordinates as its render surface.
class RenderSurface : public testing::Test {
protected:
    RenderSurface()
    {
        volume::write_msh(folder.path() / "block.msh", make_block(Vec3::Constant(0.1), {2, 2, 2}).mesh);
        folder.write("skin.obj",
                     "v 0 0 0\nv 0.1 0 0\nv 0.1 0 0.1\nv 0 0 0.1\nv 0.05 0.12 0.05\n"
                     "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.5 0.5\n"
                     "f 1/1 2/2 3/3 4/4\nf 1/1 5/5 2/2\nf 2/2 5/5 3/3\nf 3/3 5/5 4/4\nf 4/4 5/5 1/1\n");
        folder.write("block.json", R"({"toile": 1, "frames": 4, "gravity": [0, 0, 0], "cloths": [],
            "soft_bodies": [{"name": "jelly", "file": "block.msh", "render": "skin.obj", "young": 1e5,
            "velocity": [0, 3, 0], "translate": [0, 1, 0], "rotate_deg": [0, 90, 0]}],
            "render": {"width": 64, "height": 64, "samples": 1}})");
    }
    TemporaryFolder folder;
};

TEST_F(RenderSurface, IsWrittenBesideTheSurfaceThatIsChecked)
{
    const Finished run = run_toile({"simulate", "block.json", "-o", "out"}, folder.path());
    ASSERT_EQ(run.exit_code, 0) << run.errors;

    const PointCache cache = read_cache(folder.path() / "out/jelly_render.pc2");
    ASSERT_EQ(cache.frame_count(), 4);
    const std::vector<Vec3> start = cache.frame(0), end = cache.frame(3);
    ASSERT_EQ(start.size(), 5u);
    EXPECT_LT((start[1] - Vec3(0.0, 1.0, -0.1)).norm(), 1e-6) << "turned by 90 degrees";
    for (size_t v = 0; v < start.size(); ++v)
        EXPECT_LT((end[v] - start[v] - Vec3(0.0, 0.3, 0.0)).norm(), 1e-5) << v;

    Json certificate = Json::parse(bytes_of(folder.path() / "out/certificate.json"));
    EXPECT_EQ(certificate["holds"], true);
    ASSERT_EQ(certificate["cloths"].size(), 1u);
    EXPECT_EQ(certificate["cloths"][0]["name"], "jelly");
    EXPECT_TRUE(certificate["cloths_left_out"].empty());

    EXPECT_EQ(run_toile({"check", "out", "--scene", "block.json"}, folder.path()).exit_code, 0);
    EXPECT_EQ(
        run_toile({"check", "out/jelly.pc2", "out/jelly_render.pc2", "--scene", "block.json"}, folder.path())
            .exit_code,
        0);
    const Finished alone =
        run_toile({"check", "out/jelly_render.pc2", "--scene", "block.json"}, folder.path());
    EXPECT_NE(alone.exit_code, 0);
    EXPECT_NE(alone.errors.find("has only a render surface"), std::string::npos) << alone.errors;
}

TEST_F(RenderSurface, KeepsItsPolygonsAndTextureCoordinates)
{
    const Finished run = run_toile({"simulate", "block.json", "-o", "out", "--export", "skin.obj",
                                    "--export-cloth", "jelly_render", "--no-check"},
                                   folder.path());
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    const Finished checked = run_toile(
        {"simulate", "block.json", "-o", "alone", "--export", "skin.obj", "--export-cloth", "jelly_render"},
        folder.path());
    EXPECT_NE(checked.exit_code, 0);
    EXPECT_NE(checked.errors.find("gets render surfaces only"), std::string::npos) << checked.errors;
    const ObjMesh given = read_obj(folder.path() / "skin.obj"),
                  written = read_obj(folder.path() / "out/skin_0000.obj");
    EXPECT_EQ(written.polygons, given.polygons);
    EXPECT_EQ(written.polygon_uvs, given.polygon_uvs);
    EXPECT_EQ(written.texture_coordinates, given.texture_coordinates);
}

TEST_F(RenderSurface, IsDrawnInPlaceOfItsBody)
{
    ASSERT_EQ(run_toile({"simulate", "block.json", "-o", "out"}, folder.path()).exit_code, 0);
    const auto picture = [&](std::vector<std::string> caches) {
        caches.insert(caches.begin(), "render");
        for (const char* word : {"--scene", "block.json", "--frames", "0:0:1", "-o", "picture.png"})
            caches.emplace_back(word);
        const Finished run = run_toile(caches, folder.path());
        EXPECT_EQ(run.exit_code, 0) << run.errors;
        return bytes_of(folder.path() / "picture.png");
    };
    const std::string skin = picture({"out/jelly_render.pc2"});
    EXPECT_EQ(picture({"out/jelly.pc2", "out/jelly_render.pc2"}), skin);
    EXPECT_NE(picture({"out/jelly.pc2"}), skin);
}

TEST_F(RenderSurface, IsRefusedWhereItIsNotAtItsBody)
{
    folder.write("skin.obj", "v 0 0 0\nv 10 0 0\nv 0 10 0\nf 1 2 3\n");
    const Finished run = run_toile({"simulate", "block.json", "-o", "out"}, folder.path());
    EXPECT_NE(run.exit_code, 0);
    EXPECT_NE(run.errors.find("skin.obj: vertex 1 at (10, 0, 0) m is 9.9 m outside the soft body"),
              std::string::npos)
        << run.errors;
}

} // namespace
} // namespace toile::test
