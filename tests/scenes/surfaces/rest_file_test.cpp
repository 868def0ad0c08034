#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "core/mesh/obj.h"
#include "scenes/format/read_scene.h"
#include "scenes/surfaces/load_cloth.h"
#include "scenes/world/world.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

/// Rest shapes from the texture coordinates of a file of their own.
namespace toile::test {

using namespace scenes;

namespace {

constexpr int kColumns = 8, kRows = 6;

std::string line(const char* keyword, double a, double b)
{
    char text[64];
    std::snprintf(text, sizeof text, "%s %.17g %.17g", keyword, a, b);
    return text;
}

/// Sheet of 0.4 m x 0.3 m in the XY plane, as rectangles. Its texture is `width` times as wide.
/// @param is_cut  two halves with vertices of their own along the middle
std::string sheet(double width, bool is_cut = false, const std::string& name = "v")
{
    std::string text;
    for (int j = 0; j <= kRows; ++j)
        for (int i = 0; i <= kColumns + (is_cut ? 1 : 0); ++i) {
            const int column = is_cut && i > kColumns / 2 ? i - 1 : i;
            const double x = 0.4 * column / kColumns, y = 0.3 * j / kRows;
            text += line(name.c_str(), x, y) + " 0\n" + line("vt", width * x, y) + "\n";
        }
    const int stride = kColumns + (is_cut ? 2 : 1);
    for (int j = 0; j < kRows; ++j)
        for (int i = 0; i < kColumns; ++i) {
            const int v = j * stride + i + (is_cut && i >= kColumns / 2 ? 1 : 0) + 1;
            text += "f";
            for (const int k : {v, v + 1, v + stride + 1, v + stride})
                text += " " + std::to_string(k) + "/" + std::to_string(k);
            text += "\n";
        }
    return text;
}

class RestFileTest : public testing::Test {
protected:
    Scene scene_of(const std::string& keys)
    {
        return parse_scene(
            R"({"toile": 1, "frames": 20, "gravity": [0, 0, 0], "cloths": [{"name": "c", "file":
            "cloth.obj")" +
                keys + "}]}",
            folder_.path() / "scene.json");
    }

    LoadedCloth load(const std::string& keys)
    {
        const Scene scene = scene_of(R"(, "rest": "uv")" + keys);
        warnings_.clear();
        return load_cloth(scene, scene.cloths[0], {}, [this](const std::string& text) { warnings_ += text; });
    }

    /// What is refused of a rest file, without the path of its folder.
    std::string refused(const std::string& rest)
    {
        folder_.write("rest.obj", rest);
        std::string text = refusal([&] { load(R"(, "rest_file": "rest.obj")"); });
        const std::string folder = folder_.path().string() + "/";
        for (size_t at = text.find(folder); at != std::string::npos; at = text.find(folder))
            text.erase(at, folder.size());
        return text;
    }

    TemporaryFolder folder_;
    std::string warnings_;
};

TEST_F(RestFileTest, IsWhatClothRelaxesTo)
{
    folder_.write("cloth.obj", sheet(1.0));
    folder_.write("rest.obj", sheet(0.5));
    World world(scene_of(R"(, "rest": "uv", "uv_scale": 1, "rest_file": "rest.obj")"));
    world.settle();
    while (world.frame() + 1 < world.frame_count())
        EXPECT_NE(world.advance_frame().status, StepReport::Status::NonFinite);
    const Bounds box = bounds(world.cloths()[0].positions);
    EXPECT_NEAR(box.upper.x() - box.lower.x(), 0.2, 0.003) << "half of the 0.4 m that it starts with";
    EXPECT_NEAR(box.upper.y() - box.lower.y(), 0.3, 0.003);
}

/// Equal to cloth that has this texture itself, whatever is done to the mesh.
TEST_F(RestFileTest, IsAsGoodAsTheTextureOfTheCloth)
{
    for (const std::string keys :
         {R"(, "uv_scale": 1)", R"(, "subdivide": 2, "uv_scale": 0.7)", R"(, "scale": 3, "unit": "cm")",
          R"(, "weld": false, "grain_deg": 20)", R"(, "rotate_deg": [20, 30, 40], "translate": [1, 2, 3])"}) {
        SCOPED_TRACE(keys);
        folder_.write("cloth.obj", sheet(0.5, true));
        const LoadedCloth own = load(keys);
        folder_.write("cloth.obj", sheet(0.9, true));
        folder_.write("rest.obj", sheet(0.5, true));
        const LoadedCloth other = load(keys + R"(, "rest_file": "rest.obj")");
        EXPECT_EQ(other.state.panels, own.state.panels);
        EXPECT_EQ(other.state.triangles, own.state.triangles);
        EXPECT_EQ(other.rest->edges, own.rest->edges);
        EXPECT_EQ(other.note.empty(), own.note.empty());
    }
    EXPECT_NE(warnings_.find("rest.obj: texture coordinates are no flat copy"), std::string::npos)
        << warnings_;
}

TEST_F(RestFileTest, LeavesTheClothItsTexture)
{
    folder_.write("cloth.obj", sheet(0.9));
    folder_.write("rest.obj", sheet(0.5));
    const LoadedCloth loaded = load(R"(, "rest_file": "rest.obj")");
    const ObjMesh file = read_obj(folder_.path() / "cloth.obj");
    EXPECT_EQ(loaded.state.file_mesh().texture_coordinates, file.texture_coordinates);
    EXPECT_EQ(loaded.state.file_mesh().polygon_uvs, file.polygon_uvs);
}

TEST_F(RestFileTest, NeedsNoTextureOfTheClothNorPositionsOfItsOwn)
{
    std::string plain = sheet(1.0);
    for (size_t at = plain.find('/'); at != std::string::npos; at = plain.find('/'))
        plain.erase(at, plain.find_first_of(" \n", at) - at);
    folder_.write("cloth.obj", plain);
    std::string rest = sheet(0.5);
    rest.replace(rest.find("v 0 0 0"), 7, "v 9 9 9");
    folder_.write("rest.obj", rest);
    const LoadedCloth loaded = load(R"(, "uv_scale": 1, "rest_file": "rest.obj")");
    EXPECT_TRUE(loaded.state.rest.polygon_uvs.empty());
    double area = 0.0;
    for (const double triangle : loaded.rest->areas)
        area += triangle;
    EXPECT_NEAR(area, 0.2 * 0.3, 1e-12);
}

TEST_F(RestFileTest, HasTheFacesOfTheCloth)
{
    folder_.write("cloth.obj", sheet(1.0));
    const std::string remedy = "; a rest file has the faces of the cloth's";
    std::string other = sheet(1.0);
    const size_t second = other.find("f 2/2 3/3 12/12 11/11");
    ASSERT_NE(second, std::string::npos);
    EXPECT_EQ(refused(std::string(other).replace(second, 21, "f 2/2 3/3 12/12 12/12")),
              "rest.obj:128: the face has vertices 2 3 12 12, but 2 3 12 11 in cloth.obj:128" + remedy);
    EXPECT_EQ(refused(other + "f 1/1 2/2 3/3\n"), "rest.obj: has 49 faces, but cloth.obj has 48" + remedy);
}

TEST_F(RestFileTest, IsRefusedWhereItIsNoRestShape)
{
    folder_.write("cloth.obj", sheet(1.0));
    std::string plain = sheet(1.0);
    for (size_t at = plain.find('/'); at != std::string::npos; at = plain.find('/'))
        plain.erase(at, plain.find_first_of(" \n", at) - at);
    EXPECT_NE(refused(plain).find("rest.obj: has no texture coordinates"), std::string::npos);
    EXPECT_NE(refused(sheet(0.0)).find("rest.obj:127: the face has no area in the texture plane"),
              std::string::npos);
}

TEST_F(RestFileTest, RefusesKeysThatHaveNoEffect)
{
    folder_.write("cloth.obj", sheet(1.0));
    folder_.write("rest.obj", sheet(0.5));
    const auto says = [&](const std::string& keys, const std::string& text) {
        const std::string refused = refusal([&] { scene_of(keys); });
        EXPECT_NE(refused.find(text), std::string::npos) << refused;
    };
    says(
        R"(, "rest_file": "rest.obj")",
        "cloths[0].rest_file: has no effect on a rest shape that is the mesh; add \"rest\": \"uv\" or remove "
        "it");
    says(R"(, "rest": "uv", "rest_file": "none.obj")", "cloths[0].rest_file: the file ");
    says(R"(, "rest": "uv", "rest_file": "rest.glb")", "cloths[0].rest_file: \"rest.glb\" is of an unknown");
}

} // namespace
} // namespace toile::test
