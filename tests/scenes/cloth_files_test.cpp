#include <clocale>
#include <cstdlib>
#include <locale>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/base/number.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"
#include "tests/support/temporary_folder.h"

/// Cloth from meshes as people have them.
namespace toile::test {

using namespace scenes;

namespace {

/// OBJ of a sheet of 0.4 m above a ball, in `n` x `n` squares.
/// @param is_shared  false: four vertices for each square
/// @param loose      vertices before those of the sheet
std::string sheet(int n, bool is_shared, double scale = 1.0, int loose = 0)
{
    std::string text;
    for (int v = 0; v < loose; ++v)
        text += "v 7 7 7\n";
    const auto vertex = [&](int i, int k) {
        text += "v " + std::to_string(scale * (0.4 * i / n - 0.2)) + " 0 " +
                std::to_string(scale * (0.4 * k / n - 0.2)) + "\n";
    };
    for (int i = 0; i <= n && is_shared; ++i)
        for (int k = 0; k <= n; ++k)
            vertex(i, k);
    for (int i = 0; i < n && !is_shared; ++i)
        for (int k = 0; k < n; ++k)
            for (const auto& [di, dk] : {std::pair{0, 0}, {0, 1}, {1, 1}, {1, 0}})
                vertex(i + di, k + dk);
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const int corner = loose + 1 + (is_shared ? i * (n + 1) + k : 4 * (i * n + k)), row = n + 1;
            const auto face = [&](int a, int b, int c, int d) {
                text += "f " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + " " +
                        std::to_string(d) + "\n";
            };
            is_shared ? face(corner, corner + 1, corner + 1 + row, corner + row)
                      : face(corner, corner + 1, corner + 2, corner + 3);
        }
    return text;
}

class ClothFiles : public testing::Test {
protected:
    World world_of(const std::string& obj, const std::string& more = "", const std::string& top = "")
    {
        folder_.write("cloth.obj", obj);
        WorldOptions options;
        options.warn = [this](const std::string& text) { warnings_ += text + "\n"; };
        return World(parse_scene(R"({"toile": 1, "frames": 12, "avatars": [{"name": "ball", "sphere":
            {"radius": 0.15}}], "cloths": [{"name": "c", "file": "cloth.obj", "translate": [0, 0.16, 0])" +
                                     more + "}]" + top + "}",
                                 folder_.path() / "scene.json"),
                     options);
    }

    bool says(const std::string& part) const { return warnings_.find(part) != std::string::npos; }

    TemporaryFolder folder_;
    std::string warnings_;
};

void finish(World& world)
{
    while (world.frame() + 1 < world.frame_count())
        EXPECT_EQ(world.advance_frame().status, StepReport::Status::Converged);
}

TEST_F(ClothFiles, VerticesOfTheirOwnForEveryFaceBecomeOneSheet)
{
    World shared = world_of(sheet(8, true)), apart = world_of(sheet(8, false));
    EXPECT_TRUE(says("cloth.obj: joined 175 vertices along edges that lie on others")) << warnings_;
    for (int k = 0; k < 4; ++k) {
        shared.advance_frame();
        apart.advance_frame();
    }
    const ClothState &a = shared.cloths()[0], &b = apart.cloths()[0];
    EXPECT_EQ(b.positions.size(), 81u);
    // The cache is in the order of the file: its four corners of a square are where those of the sheet are.
    const std::vector<Vec3> cache = b.to_file(b.positions);
    ASSERT_EQ(cache.size(), 256u);
    EXPECT_NEAR((cache[0] - a.positions[0]).norm(), 0.0, 5e-3);
    EXPECT_EQ(cache[3], cache[32]) << "the corner (1, 0)";
    EXPECT_EQ(b.from_file(cache), b.positions);

    warnings_.clear();
    World kept = world_of(sheet(8, false), R"(, "weld": false)");
    EXPECT_EQ(kept.cloths()[0].positions.size(), 256u);
    EXPECT_EQ(warnings_, "");
}

TEST_F(ClothFiles, LooseVerticesGoAlong)
{
    World clean = world_of(sheet(4, true));
    World loose = world_of(sheet(4, true, 1.0, 2) + "v 3 3 3\n");
    EXPECT_TRUE(says("cloth.obj: 3 vertices have no face, the first is 0;")) << warnings_;
    finish(clean);
    finish(loose);
    const ClothState &a = clean.cloths()[0], &b = loose.cloths()[0];
    EXPECT_EQ(b.positions, a.positions);
    const std::vector<Vec3> cache = b.to_file(b.positions);
    ASSERT_EQ(cache.size(), 28u);
    EXPECT_EQ(cache[2], a.positions[0]);
    EXPECT_THROW(world_of(sheet(4, true) + "v 1e9 0 0\n"), InvalidInput);
    EXPECT_EQ(cache[27], a.positions[24] + Vec3(3, 3, 3) - Vec3(0.2, 0, 0.2));
}

TEST_F(ClothFiles, AttachmentsAndMessagesHaveTheNumbersOfTheFile)
{
    const std::string obj = sheet(4, false);
    const auto hold = [](int v) {
        return R"(, "attachments": [{"cloth": "c", "select": {"vertices": [)" + std::to_string(v) + "]}}]";
    };
    World world = world_of(obj, "", hold(63));
    const Vec3 held = world.cloths()[0].file_mesh().positions[63];
    finish(world);
    const ClothState& cloth = world.cloths()[0];
    EXPECT_NEAR((cloth.to_file(cloth.positions)[63] - held).norm(), 0.0, 1e-9);
    EXPECT_THROW(world_of(obj, "", hold(64)), InvalidInput);
    World fine = world_of(obj, R"(, "subdivide": 1)", hold(63));
    const std::vector<unsigned char> attached = fine.cloths()[0].attached(0.0);
    const auto at = std::find(attached.begin(), attached.end(), 1) - attached.begin();
    EXPECT_NEAR((fine.cloths()[0].positions[size_t(at)] - held).norm(), 0.0, 1e-9);
    EXPECT_THROW(world_of("v 7 7 7\n" + obj, "", hold(0)), InvalidInput) << "it has no face";
}

TEST_F(ClothFiles, RepeatedFacesAndLinesAreLeftOut)
{
    std::string obj = sheet(4, true);
    const std::string faces = obj.substr(obj.find("f "));
    World world = world_of(obj + "f 7 2 1 6\n" + faces + "l 1 2 3\n");
    EXPECT_TRUE(says("left out 17 faces with the corners of others")) << warnings_;
    EXPECT_TRUE(says("left out 2 lines between vertices; \"sewing\": {} sews along them")) << warnings_;
    EXPECT_EQ(world.cloths()[0].triangles.size(), 32u);
    finish(world);
}

/// A flap on a seam in the middle of the sheet, as pockets have: three faces share its edge.
TEST_F(ClothFiles, MayBeSewnOntoThemselves)
{
    World flap = world_of(sheet(8, true) + "v -0.05 0.035 0.035\nv 0 0.035 0.035\nf 32 41 83 82\n");
    EXPECT_TRUE(says("1 edge is shared by more than two faces")) << warnings_;
    finish(flap);
    const std::vector<Vec3>& x = flap.cloths()[0].positions;
    EXPECT_NEAR((x[81] - x[31]).norm(), 0.05, 3e-3);
    EXPECT_NEAR((x[82] - x[40]).norm(), 0.05, 3e-3);
    EXPECT_LT(x[81].y(), x[31].y() + 0.01) << "it falls over, about its seam";
}

/// Three panels end at one edge, which stays open; seams beside it join all their vertices there.
TEST_F(ClothFiles, SeamsMayMakeAnEdgeOfThreeFaces)
{
    const std::string a = "v 0 0 0\nv .1 0 0\nv .2 0 0\nv -.1 0 0\nv .05 0 .1\n"
                          "f 1 2 5\nf 2 3 5\nf 4 1 5\n";
    const std::string b = "v 0 0 0\nv .1 0 0\nv .2 0 0\nv -.1 0 0\nv .05 .1 0\n"
                          "v -.1 -.05 0\nv -.1 -.05 .1\nv .2 -.05 0\nv .2 -.05 .1\n"
                          "f 6 7 10\nf 7 8 10\nf 9 6 10\nf 6 11 12\nf 7 13 14\n";
    const std::string c = "v 0 0 0\nv .1 0 0\nv -.1 -.05 0\nv .2 -.05 0\nv .05 -.1 0\n"
                          "f 15 16 19\nf 15 17 19\nf 16 18 19\n";
    world_of(a + b + c, "", R"(, "contact": {"repair_start": false})");
    EXPECT_TRUE(says("1 edge is shared by more than two faces")) << warnings_;
    EXPECT_TRUE(says("\"weld\": false keeps seams apart")) << warnings_;
}

TEST_F(ClothFiles, FacesOfOneSideOnlyAreNamedByTheirLines)
{
    std::string strip;
    for (int i = 0; i < 12; ++i)
        for (const double s : {-0.05, 0.05}) {
            const double angle = std::numbers::pi * i / 6.0, r = 0.3 + s * std::cos(0.5 * angle);
            strip += "v " + std::to_string(r * std::cos(angle)) + " " +
                     std::to_string(s * std::sin(0.5 * angle)) + " " + std::to_string(r * std::sin(angle)) +
                     "\n";
        }
    for (int i = 1; i < 23; i += 2)
        strip += "f " + std::to_string(i) + " " + std::to_string(i + 1) + " " + std::to_string(i + 3) + " " +
                 std::to_string(i + 2) + "\n";
    try {
        world_of(strip + "f 23 24 1 2\n");
        ADD_FAILURE();
    } catch (const InvalidInput& error) {
        EXPECT_NE(std::string(error.what()).find("cloth.obj: the faces in lines "), std::string::npos);
        EXPECT_NE(std::string(error.what()).find("one side only, as a Moebius strip; cut it"),
                  std::string::npos);
    }
}

TEST_F(ClothFiles, CurvesAndRepeatedCornersAreLeftOut)
{
    World world = world_of(sheet(4, true) + "v 0.3 0 0\nf 25 26 26 24\nf 1 1 2\ncurv 0 1 1 2\n");
    EXPECT_TRUE(says("left out 1 curve or curved surface; only polygons are read")) << warnings_;
    EXPECT_TRUE(says("left out corners of 2 faces that repeat the one before")) << warnings_;
    EXPECT_EQ(world.cloths()[0].triangles.size(), 33u);
}

TEST_F(ClothFiles, PointsFarFromTheClothAreWarnedOf)
{
    const auto nearest = [](const std::string& x) {
        return R"(, "attachments": [{"cloth": "c", "select": {"nearest": [[0, 0.1, 0], [)" + x + "]]}}]";
    };
    world_of(sheet(4, true), "", nearest("20, 16, 20"));
    EXPECT_TRUE(says("attachments[0].select.nearest[1]: is 32.2 m away from \"c\"")) << warnings_;
    warnings_.clear();
    world_of(sheet(4, true), "", nearest("0.3, 0.2, 0"));
    EXPECT_EQ(warnings_, "");
}

TEST_F(ClothFiles, AForgottenUnitOfABodyIsSuggested)
{
    const auto body = [&](const std::string& size, const std::string& more) {
        folder_.write("body.obj", "v 0 -2 0\nv " + size +
                                      " -2 0\nv 0 -3 0\nv 0 -2 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n");
        folder_.write("scene.json",
                      R"({"toile": 1, "frames": 1, "cloths": [{"name": "c", "disc": {}}], )" + more + "}");
        WorldOptions options;
        options.warn = [this](const std::string& text) { warnings_ += text + "\n"; };
        World(read_scene(folder_.path() / "scene.json"), options);
    };
    body("170", R"("avatars": [{"name": "b", "file": "body.obj"}])");
    EXPECT_TRUE(says("body.obj: is 170 m long; if its lengths are in cm, write \"unit\": \"cm\""))
        << warnings_;
    warnings_.clear();
    body("170", R"("solids": [{"name": "b", "file": "body.obj"}])");
    EXPECT_TRUE(says("body.obj: is 170 m long; if its lengths are in cm")) << warnings_;
    warnings_.clear();
    body("30", R"("avatars": [{"name": "b", "file": "body.obj"}])");
    EXPECT_EQ(warnings_, "") << "a floor";
}

TEST_F(ClothFiles, AForgottenUnitIsSuggested)
{
    world_of(sheet(4, true, 100.0));
    EXPECT_TRUE(says("is 56.6 m long; if its lengths are in cm, write \"unit\": \"cm\"")) << warnings_;
    warnings_.clear();
    world_of(sheet(4, true, 1000.0));
    EXPECT_TRUE(says("\"unit\": \"mm\"")) << warnings_;
    warnings_.clear();
    world_of(sheet(4, true, 100.0), R"(, "unit": "cm")");
    world_of(sheet(4, true));
    EXPECT_EQ(warnings_, "");
}

/// A locale with a decimal comma until the end of a test, made where the machine has the sources of one.
class DecimalComma {
public:
    DecimalComma()
    {
        const std::string name = "de_DE.UTF-8", file = (folder_.path() / name).string();
        if (std::system(("localedef -i de_DE -f UTF-8 " + file + " > /dev/null 2>&1").c_str()) != 0)
            return;
        ::setenv("LOCPATH", folder_.path().c_str(), 1);
        if (std::setlocale(LC_ALL, name.c_str()) != nullptr)
            previous_ = std::locale::global(std::locale(name));
    }
    ~DecimalComma()
    {
        std::locale::global(previous_);
        std::setlocale(LC_ALL, "C");
        ::unsetenv("LOCPATH");
    }
    bool is_set() const { return *std::localeconv()->decimal_point == ','; }

private:
    TemporaryFolder folder_;
    std::locale previous_;
};

/// Programs that show windows set the locale of their user.
TEST_F(ClothFiles, AreReadAndWrittenAlikeInEveryLocale)
{
    const std::string obj = sheet(4, true);
    const auto write = [&](const std::string& name) {
        const World world = world_of(obj, R"(, "fabric": "cotton")");
        const ClothState& cloth = world.cloths()[0];
        write_obj(folder_.path() / name,
                  ObjMesh{.positions = cloth.positions, .polygons = cloth.rest.polygons});
        return bytes_of(folder_.path() / name);
    };
    const std::string expected = write("c.obj");
    EXPECT_NE(expected.find("v -0.1 0.16 "), std::string::npos) << expected;
    const DecimalComma german;
    if (!german.is_set())
        GTEST_SKIP() << "no locale with a decimal comma can be made here";
    EXPECT_EQ(write("de.obj"), expected);
    EXPECT_EQ(read_obj(folder_.path() / "de.obj").positions, read_obj(folder_.path() / "c.obj").positions);
    EXPECT_EQ(number_in("1.5"), 1.5);
    EXPECT_EQ(number_in("1.5e-400"), 0.0);
    EXPECT_EQ(number_in("1.5e400"), std::nullopt);
}

} // namespace
} // namespace toile::test
