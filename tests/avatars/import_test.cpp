#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "avatars/load_avatar.h"
#include "core/base/error.h"
#include "core/mesh/obj.h"
#include "core/mesh/topology.h"
#include "tests/avatars/column.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

using namespace avatars;

namespace {

std::filesystem::path data_file(const std::string& name)
{
    return std::filesystem::path(TOILE_DATA_DIR) / name;
}

std::unique_ptr<Avatar> load(const std::filesystem::path& file)
{
    AvatarSettings settings;
    settings.file = file;
    return load_avatar(settings);
}

/// One-line message of load_avatar(); empty if it accepts the file.
std::string refusal(const AvatarSettings& settings)
{
    try {
        load_avatar(settings);
        return "";
    } catch (const InvalidInput& error) {
        return error.what();
    }
}

/// Column's file with one piece of text replaced, saved under another name.
AvatarSettings edited_column(const std::string& name, const std::string& from, const std::string& to)
{
    std::stringstream content;
    content << std::ifstream(column_file()).rdbuf();
    std::string text = content.str();
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    AvatarSettings settings;
    settings.file = process_folder() / name;
    std::ofstream(settings.file) << text;
    return settings;
}

void expect_line(const std::string& message, const std::vector<std::string>& parts)
{
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const std::string& part : parts)
        EXPECT_NE(message.find(part), std::string::npos) << "no '" << part << "' in: " << message;
}

struct BodyFacts {
    const char* file;
    int vertices, triangles;
    double height; ///< [m]
};

} // namespace

class RealBody : public testing::TestWithParam<BodyFacts> {};

TEST_P(RealBody, ArrivesClosedManifoldAndInMetres)
{
    const BodyFacts& facts = GetParam();
    if (!std::filesystem::exists(data_file(facts.file)))
        GTEST_SKIP() << "SKIPPED: TOILE_DATA_DIR has no " << facts.file;
    const auto avatar = load(data_file(facts.file));
    EXPECT_EQ(avatar->vertex_count(), facts.vertices);
    EXPECT_EQ(int(avatar->triangles().size()), facts.triangles);
    EXPECT_TRUE(build_topology(avatar->triangles(), avatar->vertex_count(), facts.file).is_closed());
    const std::vector<Vec3> x = posed(*avatar, {});
    const Bounds box = bounds(x);
    EXPECT_NEAR(box.upper.y() - box.lower.y(), facts.height, 0.005);
}

INSTANTIATE_TEST_SUITE_P(Import, RealBody,
                         testing::Values(BodyFacts{"avatars/mh_woman.glb", 13380, 26756, 1.68},
                                         BodyFacts{"avatars/mh_man.glb", 13380, 26756, 1.78},
                                         BodyFacts{"avatars/gc_mean_all.glb", 23752, 47500, 1.72},
                                         BodyFacts{"avatars/cesium_man.gltf", 2338, 4672, 1.507},
                                         BodyFacts{"avatars/arnaud.fbx", 3337, 6670, 1.83}),
                         [](const auto& body) {
                             return std::filesystem::path(body.param.file).stem().string();
                         });

TEST(Import, TheDanceMovesTheWomanByMetres)
{
    if (!std::filesystem::exists(data_file("avatars/mh_woman.glb")))
        GTEST_SKIP() << "SKIPPED: TOILE_DATA_DIR has no avatars/mh_woman.glb";
    const auto avatar = load(data_file("avatars/mh_woman.glb"));
    const int dance = avatar->clip_index("dance");
    EXPECT_NEAR(avatar->clips()[dance].duration, 16.5, 1e-3);
    const std::vector<Vec3> rest = posed(*avatar, {});
    double largest = 0.0;
    for (int k = 0; k <= 60; ++k) {
        const std::vector<Vec3> x = posed(*avatar, {dance, 16.5 * k / 60});
        for (size_t v = 0; v < x.size(); ++v)
            largest = std::max(largest, (x[v] - rest[v]).norm());
    }
    EXPECT_GT(largest, 2.3);
    EXPECT_LT(largest, 4.2);
}

TEST(Import, JoinsTheSeamOfTheColumn)
{
    const auto avatar = load(column_file());
    EXPECT_EQ(avatar->vertex_count(), 12);
    EXPECT_EQ(avatar->triangles().size(), 20u);
    EXPECT_TRUE(build_topology(avatar->triangles(), 12, "column").is_closed());
    ASSERT_EQ(avatar->clips().size(), 2u);
    EXPECT_DOUBLE_EQ(avatar->clips()[avatar->clip_index("bend")].duration, 1.0);
}

TEST(Import, KeepsTheVertexOrderOfAnObj)
{
    ObjMesh mesh;
    mesh.positions = {{0, 0, 3}, {1, 0, 0}, {0, 2, 0}, {5, 5, 5}};
    mesh.polygons = {{2, 0, 1}};
    const std::filesystem::path file = process_folder() / "toile_order.obj";
    write_obj(file, mesh);
    const auto avatar = load(file);
    EXPECT_TRUE(avatar->is_static());
    EXPECT_EQ(avatar->triangles()[0], Triangle(2, 0, 1));
    EXPECT_EQ(posed(*avatar, {}), mesh.positions);
}

TEST(Import, ConvertsUnitsToMetresAndTheUpAxisToY)
{
    AvatarSettings settings;
    settings.file = column_file();
    settings.unit = "in";
    settings.up = "z";
    const std::vector<Vec3> original = posed(*load(column_file()), {});
    const std::vector<Vec3> x = posed(*load_avatar(settings), {});
    for (size_t v = 0; v < x.size(); ++v)
        EXPECT_LT((x[v] - 0.0254 * Vec3(original[v].x(), original[v].z(), -original[v].y())).norm(), 1e-15);
}

TEST(Import, RefusesBadFilesInOneLine)
{
    AvatarSettings missing;
    missing.file = "no/such/body.glb";
    expect_line(refusal(missing), {"no/such/body.glb", "no such file"});

    AvatarSettings unit;
    unit.file = column_file();
    unit.unit = "furlong";
    expect_line(refusal(unit), {"furlong", "m, cm, mm or in"});
    unit.unit = "m";
    unit.up = "w";
    expect_line(refusal(unit), {"'w'", "y or z"});

    expect_line(refusal(edited_column("toile_broken.gltf", "\"accessors\"", "accessors")),
                {"toile_broken.gltf", "can't be read"});
    expect_line(refusal(edited_column("toile_empty.gltf", "\"mesh\": 0,", "")),
                {"toile_empty.gltf", "no mesh"});
    expect_line(refusal(edited_column("toile_loose.gltf", "\"WEIGHTS_0\": 3", "\"WEIGHTS_0\": 4")),
                {"toile_loose.gltf", "vertex 7 has no bone weight"});
}

TEST(Import, RefusesAnObjWithoutASurface)
{
    for (const auto& [obj, says] : std::vector<std::pair<std::string, std::string>>{
             {"v 0 0 0\n", "no triangles"},
             {"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\nf 1 1 2\n", "no triangle has an area"}}) {
        AvatarSettings settings;
        settings.file = process_folder() / "toile_no_surface.obj";
        std::ofstream(settings.file) << obj;
        expect_line(refusal(settings), {"toile_no_surface.obj", says, "an avatar needs a surface"});
    }
}

TEST(Import, NamesTheNearestClipAndListsAll)
{
    try {
        load(column_file())->clip_index("bnd");
        FAIL() << "accepted";
    } catch (const InvalidInput& error) {
        expect_line(error.what(), {"no clip 'bnd'", "did you mean 'bend'", "'bend', 'slide'"});
    }
}

} // namespace toile::test
