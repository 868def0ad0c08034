#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <numeric>

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include "scenes/format/read_scene.h"
#include "scenes/surfaces/load_cloth.h"
#include "scenes/world/scene_cloth.h"
#include "scenes/world/world.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

/// Rest shapes from texture coordinates.
namespace toile::test {

using namespace scenes;

namespace {

std::string line(const char* keyword, const std::vector<double>& numbers)
{
    std::string text = keyword;
    for (const double number : numbers) {
        char word[32];
        std::snprintf(word, sizeof word, " %.17g", number);
        text += word;
    }
    return text + "\n";
}

/// OBJ of a grid over (s, t) in [0, 1]^2, in triangles; each corner has the texture index of its vertex.
std::string grid(int columns, int rows, const std::function<Vec3(double, double)>& position,
                 const std::function<Vec2(double, double)>& texture)
{
    std::string text;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i) {
            const double s = double(i) / columns, t = double(j) / rows;
            const Vec3 p = position(s, t);
            const Vec2 uv = texture(s, t);
            text += line("v", {p.x(), p.y(), p.z()}) + line("vt", {uv.x(), uv.y()});
        }
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const auto corner = [&](int di, int dj) {
                const std::string k = std::to_string((j + dj) * (columns + 1) + i + di + 1);
                return std::string(" ").append(k).append("/").append(k);
            };
            text += "f" + corner(0, 0) + corner(1, 1) + corner(1, 0) + "\nf" + corner(0, 0) + corner(0, 1) +
                    corner(1, 1) + "\n";
        }
    return text;
}

/// Sheet of 0.4 m x 0.3 m in the XZ plane, stretched along X in space.
Vec3 posed(double s, double t, double stretch = 1.0)
{
    const double bent = s + 0.1 * std::sin(std::numbers::pi * s) * t; // triangles of many shapes
    return {0.4 * bent * stretch, 0.0, -0.3 * t};
}

Vec2 flat(double s, double t)
{
    const Vec3 p = posed(s, t);
    return {p.x(), -p.z()};
}

class UvRestTest : public testing::Test {
protected:
    Scene scene_of(const std::string& obj, const std::string& keys, const std::string& top = "")
    {
        folder_.write("cloth.obj", obj);
        return parse_scene(
            R"({"toile": 1, "frames": 20, "gravity": [0, 0, 0], "cloths": [{"name": "c", "file":
            "cloth.obj")" +
                keys + "}]" + top + "}",
            folder_.path() / "scene.json");
    }

    LoadedCloth load(const std::string& obj, const std::string& keys = "")
    {
        const Scene scene = scene_of(obj, R"(, "rest": "uv")" + keys);
        warnings_.clear();
        return load_cloth(scene, scene.cloths[0], {}, [this](const std::string& text) { warnings_ += text; });
    }

    /// What is refused of a file, after the path of its folder.
    std::string refused(const std::string& obj, const std::string& keys = "")
    {
        const std::string text = refusal([&] { load(obj, keys); });
        const std::string folder = folder_.path().string() + "/";
        return text.starts_with(folder) ? text.substr(folder.size()) : text;
    }

    TemporaryFolder folder_;
    std::string warnings_;
};

double area_of(const garment::RestShape& rest)
{
    return std::accumulate(rest.areas.begin(), rest.areas.end(), 0.0);
}

/// Largest principal stretch minus one of all triangles [-], and the smallest.
std::pair<double, double> strain_of(const garment::RestShape& rest, View<const Vec3> x)
{
    double largest = -1.0, smallest = 1e9;
    for (int t = 0; t < int(rest.triangles.size()); ++t) {
        const Eigen::JacobiSVD<Eigen::MatrixXd> svd(Eigen::MatrixXd(rest.deformation_gradient(t, x)));
        largest = std::max(largest, svd.singularValues()[0] - 1.0);
        smallest = std::min(smallest, svd.singularValues()[1] - 1.0);
    }
    return {largest, smallest};
}

TEST_F(UvRestTest, OfASheetInItsPlaneIsItsShape)
{
    const std::string obj = grid(
        8, 6, [](double s, double t) { return posed(s, t); }, flat);
    const Scene by_shape = scene_of(obj, "");
    const LoadedCloth shape = load_cloth(by_shape, by_shape.cloths[0], {}, {});
    // The warp of a flat sheet is its X axis, which is a quarter turn clockwise from v.
    const LoadedCloth uv = load(obj, R"(, "uv_scale": 1, "grain_deg": -90)");
    ASSERT_EQ(uv.rest->edges.size(), shape.rest->edges.size());
    for (size_t t = 0; t < shape.rest->edges.size(); ++t) {
        EXPECT_LT((uv.rest->edges[t] - shape.rest->edges[t]).norm(), 1e-15);
        EXPECT_NEAR(uv.rest->areas[t], shape.rest->areas[t], 1e-16);
    }
    EXPECT_EQ(warnings_, "");
    EXPECT_EQ(uv.note, "");
    EXPECT_TRUE(shape.state.panels.empty());
}

TEST_F(UvRestTest, MovesAsTheShapeThatItEquals)
{
    const std::string obj = grid(
        8, 6, [](double s, double t) { return posed(s, t); }, flat);
    const std::string top = R"(, "wind": {"velocity": [0, 3, 1]},
        "attachments": [{"cloth": "c", "select": {"vertices": [0, 8]}}])";
    World shape(scene_of(obj, "", top));
    World uv(scene_of(obj, R"(, "rest": "uv", "grain_deg": -90)", top));
    for (int k = 0; k < 5; ++k) {
        shape.advance_frame();
        uv.advance_frame();
    }
    for (size_t v = 0; v < shape.cloths()[0].positions.size(); ++v)
        EXPECT_NEAR((shape.cloths()[0].positions[v] - uv.cloths()[0].positions[v]).norm(), 0.0, 1e-5);
}

TEST_F(UvRestTest, HasTheWarpAlongTheVOfTheTexture)
{
    const std::string obj = grid(
        4, 4, [](double s, double t) { return posed(s, t); }, flat);
    const LoadedCloth straight = load(obj, R"(, "uv_scale": 1)"),
                      turned = load(obj, R"(, "uv_scale": 1, "grain_deg": 30)");
    for (size_t t = 0; t < straight.state.panels.size(); ++t) {
        const FlatTriangle& corner = straight.state.panels[t];
        for (int k = 0; k < 2; ++k) {
            const Vec2 edge = corner[size_t(k) + 1] - corner[0];
            EXPECT_NEAR(straight.rest->edges[t](0, k), edge.y(), 1e-15);
            // Counter-clockwise from v: (-sin 30, cos 30).
            EXPECT_NEAR(turned.rest->edges[t](0, k), -0.5 * edge.x() + std::sqrt(0.75) * edge.y(), 1e-15);
        }
        EXPECT_GT(straight.rest->edges[t].determinant(), 0.0);
    }
}

TEST_F(UvRestTest, MirrorsPanelsAboutTheirWarp)
{
    const auto place = [](double s, double t) { return posed(s, t); };
    const LoadedCloth straight = load(grid(5, 4, place, flat), R"(, "grain_deg": 20)");
    const LoadedCloth mirrored = load(grid(5, 4, place,
                                           [](double s, double t) {
                                               const Vec2 uv = flat(s, t);
                                               return Vec2(1.0 - uv.x(), uv.y());
                                           }),
                                      R"(, "grain_deg": -20)");
    for (size_t t = 0; t < straight.rest->edges.size(); ++t) {
        EXPECT_GT(mirrored.rest->edges[t].determinant(), 0.0);
        for (int k = 0; k < 2; ++k)
            EXPECT_NEAR(mirrored.rest->edges[t](0, k), straight.rest->edges[t](0, k), 1e-12);
        EXPECT_NEAR((mirrored.rest->edges[t] - straight.rest->edges[t]).norm(), 0.0, 1e-12);
    }
}

TEST_F(UvRestTest, FitsTheScaleToTheAreasAndSaysSo)
{
    const auto texture = [](double s, double t) { return Vec2(25.0 * flat(s, t) + Vec2(3, -7)); };
    const std::string obj = grid(
        8, 6, [](double s, double t) { return posed(s, t); }, texture);
    const LoadedCloth found = load(obj, R"(, "scale": 2, "unit": "cm")");
    EXPECT_NE(
        found.note.find("cloth.obj: \"uv_scale\": 0.0004 makes the areas at rest and of the mesh equal"),
        std::string::npos)
        << found.note;
    double posed_area = 0.0;
    for (const Triangle& t : found.state.triangles)
        posed_area += 0.5 * (found.state.positions[t[1]] - found.state.positions[t[0]])
                                .cross(found.state.positions[t[2]] - found.state.positions[t[0]])
                                .norm();
    EXPECT_NEAR(area_of(*found.rest), posed_area, 1e-12 * posed_area);

    // In metres, before scale; the unit of the file does not apply.
    const LoadedCloth told = load(obj, R"(, "scale": 2, "unit": "cm", "uv_scale": 0.0004)");
    EXPECT_NEAR(area_of(*told.rest), posed_area, 1e-12 * posed_area);
    EXPECT_EQ(told.note, "");
}

TEST_F(UvRestTest, WarnsWhereTheTextureIsNoFlatCopyOfTheMesh)
{
    const auto place = [](double s, double t) { return posed(s, t); };
    load(grid(8, 6, place, [](double s, double t) { return Vec2(s * s + 0.1 * s, t); }));
    EXPECT_NE(
        warnings_.find("cloth.obj: texture coordinates are no flat copy of the mesh: its triangles are "),
        std::string::npos)
        << warnings_;
    EXPECT_EQ(warnings_.find('\n'), std::string::npos);
    // Of the right area, but twice as long across as along.
    load(grid(8, 6, place, [](double s, double t) { return Vec2(flat(s, t).x(), 2.0 * flat(s, t).y()); }));
    EXPECT_NE(warnings_.find("are 0.707 to 1.41 times as long as at rest"), std::string::npos) << warnings_;
    load(grid(8, 6, place, flat), R"(, "uv_scale": 100)");
    EXPECT_NE(warnings_.find("are 0.01 to 0.01 times as long as at rest (5 % to 95 % of them), and will "
                             "shrink or grow; \"uv_scale\": 1 makes the areas"),
              std::string::npos)
        << warnings_;
}

TEST_F(UvRestTest, SubdividesTheTexture)
{
    const auto place = [](double s, double t) { return posed(s, t); };
    const LoadedCloth coarse = load(grid(4, 3, place, flat), R"(, "uv_scale": 1)");
    const LoadedCloth fine = load(grid(4, 3, place, flat), R"(, "uv_scale": 1, "subdivide": 2)");
    ASSERT_EQ(fine.rest->areas.size(), 16 * coarse.rest->areas.size());
    for (size_t t = 0; t < fine.rest->areas.size(); ++t) {
        EXPECT_NEAR(fine.rest->areas[t], coarse.rest->areas[t / 16] / 16.0, 1e-15);
        for (int k = 0; k < 3; ++k) {
            const Vec3& p = fine.state.positions[fine.state.triangles[t][k]];
            EXPECT_NEAR((fine.state.panels[t][size_t(k)] - Vec2(p.x(), -p.z())).norm(), 0.0, 1e-15);
        }
    }
}

/// A sheet that was posed longer than it is cut takes the length of its texture.
TEST_F(UvRestTest, IsWhatPosedClothRelaxesTo)
{
    const std::string obj = grid(
        12, 9, [](double s, double t) { return posed(s, t, 1.1); }, flat);
    World world(scene_of(obj, R"(, "rest": "uv", "uv_scale": 1)"));
    world.settle();
    while (world.frame() + 1 < world.frame_count())
        EXPECT_NE(world.advance_frame().status, StepReport::Status::NonFinite);
    const std::vector<Vec3>& x = world.cloths()[0].positions;
    EXPECT_NEAR((x.back() - x.front()).norm(), 0.5, 0.002);
    const auto [largest, smallest] = strain_of(*load(obj, R"(, "uv_scale": 1)").rest, x);
    EXPECT_LT(largest, 0.005);
    EXPECT_GT(smallest, -0.02);
}

/// Beyond the limit of the fabric it does so before sample 0, unless its start is to be left alone.
TEST_F(UvRestTest, RelaxesBeforeSampleZero)
{
    const std::string obj = grid(
        12, 9, [](double s, double t) { return posed(s, t, 1.3); }, flat);
    const std::string keys = R"(, "rest": "uv", "uv_scale": 1, "fabric": "denim")";
    World relaxed(scene_of(obj, keys)), kept(scene_of(obj, keys, R"(, "contact": {"repair_start": false})"));
    const LoadedCloth loaded = load(obj, R"(, "uv_scale": 1, "fabric": "denim")");
    EXPECT_NEAR(strain_of(*loaded.rest, relaxed.cloths()[0].positions).first, 0.3, 1e-9);
    relaxed.settle();
    kept.settle();
    EXPECT_LT(strain_of(*loaded.rest, relaxed.cloths()[0].positions).first,
              loaded.state.fabric.strain_limit + 0.05);
    EXPECT_EQ(kept.cloths()[0].positions, loaded.state.positions);
}

/// A ruffle: the lower panel is half as long again as the edge that it is sewn to.
TEST_F(UvRestTest, MayHaveLongerPanelsAlongASeam)
{
    std::string obj;
    const auto vertex = [&](int i, int j) { obj += line("v", {0.02 * i, -0.02 * j, 0.002 * (i % 2)}); };
    for (int j = 0; j <= 6; ++j)
        for (int i = 0; i <= 10; ++i)
            vertex(i, j);
    for (const double width : {0.02, 0.03}) // panels above and below row 3
        for (int j = 0; j <= 3; ++j)
            for (int i = 0; i <= 10; ++i)
                obj += line("vt", {width * i, -0.02 * j + (width > 0.02 ? 1.0 : 0.0)});
    for (int j = 0; j < 6; ++j)
        for (int i = 0; i < 10; ++i) {
            const auto corner = [&](int di, int dj) {
                const int v = 11 * (j + dj) + i + di + 1;
                return " " + std::to_string(v) + "/" + std::to_string(j < 3 ? v : v + 11);
            };
            obj += "f" + corner(0, 0) + corner(0, 1) + corner(1, 1) + corner(1, 0) + "\n";
        }
    World world(
        scene_of(obj, R"(, "rest": "uv", "uv_scale": 1)", R"(, "attachments": [{"cloth": "c", "select":
        {"box": {"lower": [-1, -0.001, -1], "upper": [1, 0.001, 1]}}}])"));
    EXPECT_NE(world.settle().status, StepReport::Status::NonFinite);
    while (world.frame() + 1 < world.frame_count())
        EXPECT_NE(world.advance_frame().status, StepReport::Status::NonFinite);
    const std::vector<Vec3>& x = world.cloths()[0].positions;
    double hem = 0.0;
    for (size_t v = 66; v < 76; ++v)
        hem += (x[v + 1] - x[v]).norm();
    EXPECT_NEAR(hem, 0.3, 0.01) << "the hem of the ruffle has the length of its panel";
}

/// OBJ of a tube about the Y axis whose vertices are shared along a seam, and its flat panel.
std::string tube(int around, int rows, double radius, double height)
{
    const double width = 2.0 * radius * std::sin(std::numbers::pi / around);
    std::string text;
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i < around; ++i) {
            const double angle = 2.0 * std::numbers::pi * i / around;
            text += line("v", {radius * std::sin(angle), -height * j / rows, radius * std::cos(angle)});
        }
        for (int i = 0; i <= around; ++i)
            text += line("vt", {width * i, -height * j / rows});
    }
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < around; ++i) {
            const auto corner = [&](int di, int dj) {
                return " " + std::to_string((j + dj) * around + (i + di) % around + 1) + "/" +
                       std::to_string((j + dj) * (around + 1) + i + di + 1);
            };
            text += "f" + corner(0, 0) + corner(0, 1) + corner(1, 1) + corner(1, 0) + "\n";
        }
    return text;
}

TEST_F(UvRestTest, OfASewnTubeIsItsPanel)
{
    const std::string obj = tube(24, 10, 0.15, 0.4);
    const LoadedCloth loaded = load(obj);
    EXPECT_EQ(warnings_, "");
    EXPECT_EQ(loaded.state.positions.size(), 24u * 11u);
    const auto [largest, smallest] = strain_of(*loaded.rest, loaded.state.positions);
    EXPECT_LT(std::max(largest, -smallest), 1e-12);

    World world(scene_of(obj, R"(, "rest": "uv")", R"(, "attachments": [{"cloth": "c", "select": {"box":
        {"lower": [-1, -0.01, -1], "upper": [1, 0.01, 1]}}}])"));
    while (world.frame() + 1 < world.frame_count())
        EXPECT_EQ(world.advance_frame().status, StepReport::Status::Converged);
    EXPECT_LT(strain_of(*loaded.rest, world.cloths()[0].positions).first, 0.01);
}

/// Panels of a garment are cut at separate places in the plane, the back ones clockwise.
TEST_F(UvRestTest, JoinsPanelsOfAnyOrientation)
{
    // Two squares that share an edge; vt apart, the second one mirrored.
    const std::string obj = "v 0 0 0\nv .1 0 0\nv .1 .1 0\nv 0 .1 0\nv .2 0 0\nv .2 .1 0\n"
                            "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 7 0\nvt 6 0\nvt 6 1\nvt 7 1\n"
                            "f 1/1 2/2 3/3 4/4\nf 2/5 5/6 6/7 3/8\n";
    const LoadedCloth loaded = load(obj);
    EXPECT_EQ(warnings_, "");
    EXPECT_NEAR(area_of(*loaded.rest), 0.02, 1e-15);
    for (const Mat2& edges : loaded.rest->edges)
        EXPECT_GT(edges.determinant(), 0.0);
    const auto [largest, smallest] = strain_of(*loaded.rest, loaded.state.positions);
    EXPECT_LT(std::max(largest, -smallest), 1e-12);
}

/// Faces that are wound against their neighbours are no folds of the texture.
TEST_F(UvRestTest, KnowsFlippedFacesFromFolds)
{
    const std::string sheet = "v 0 0 0\nv .1 0 0\nv .1 .1 0\nv 0 .1 0\nv .2 0 0\nv .2 .1 0\n"
                              "vt 0 0\nvt .1 0\nvt .1 .1\nvt 0 .1\nvt .2 0\nvt .2 .1\nf 1/1 2/2 3/3 4/4\n";
    const LoadedCloth loaded = load(sheet + "f 3/3 6/6 5/5 2/2\n");
    EXPECT_NE(warnings_.find("flipped 1 face"), std::string::npos) << warnings_;
    EXPECT_NEAR(area_of(*loaded.rest), 0.02, 1e-15);
}

TEST_F(UvRestTest, CutsPolygonsAsTheMeshIsCut)
{
    const std::string obj = "v 0 0 0\nv .2 0 0\nv .2 0 -.1\nv .1 0 -.1\nv .1 0 -.2\nv 0 0 -.2\n"
                            "vt 0 0\nvt 2 0\nvt 2 1\nvt 1 1\nvt 1 2\nvt 0 2\nf 1/1 2/2 3/3 4/4 5/5 6/6\n";
    const LoadedCloth loaded = load(obj);
    ASSERT_EQ(loaded.rest->areas.size(), 4u);
    const auto [largest, smallest] = strain_of(*loaded.rest, loaded.state.positions);
    EXPECT_LT(std::max(largest, -smallest), 1e-12);
}

TEST_F(UvRestTest, RefusesTexturesThatAreNoRestShape)
{
    const std::string points = "v 0 0 0\nv .1 0 0\nv .1 .1 0\nv 0 .1 0\n";
    const std::string texture = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
    const std::string half = "f 1/1 2/2 3/3\n";
    const std::string or_shape = ", or write \"rest\": \"shape\"";
    EXPECT_EQ(refused(points + "f 1 2 3 4\n"),
              "cloth.obj: has no texture coordinates, which \"rest\": \"uv\" needs; export it with UVs" +
                  or_shape);
    EXPECT_EQ(
        refused(points + texture + half + "f 1 3 4\n"),
        "cloth.obj:10: the face has no texture coordinates, which \"rest\": \"uv\" needs at every corner; "
        "write its corners as v/vt" +
            or_shape);
    EXPECT_EQ(
        refused(points + texture + half + "f 1/1 3 4/4\n"),
        "cloth.obj:10: some corners of the face have a texture index and some have none; give all or none");
    EXPECT_EQ(
        refused(points + texture + half + "f 1/1 3/3 4/1\n"),
        "cloth.obj:10: the face has no area in the texture plane: its corners are at (0, 0), (1, 1) and "
        "(0, 0); unwrap it there" +
            or_shape);
    EXPECT_EQ(refused(points + "vt 0 0\nvt 1 0\nvt 1 nan\n"),
              "cloth.obj:7: 'nan' is not a finite number; write a decimal number: -0.25, 3e-4");
    EXPECT_EQ(
        refused(points + texture + "vt 0.9 0.1\nf 1/1 2/2 3/3 4/5\n"),
        "cloth.obj:10: the face folds over itself in the texture plane, along (0, 0) to (1, 1); unfold the "
        "texture there" +
            or_shape);
    EXPECT_EQ(
        refused(points + texture + "f 1/1 2/2 3/3 4/4\n", R"(, "uv_scale": 999999)"),
        "cloth.obj: texture coordinates times \"uv_scale\" 999999 are at (999999, 0) m; they must be finite "
        "and at most 100 km");
    EXPECT_EQ(refused(points + texture + "f 1/1 2/2 3/3 4/4\n", R"(, "uv_scale": 1e-200)"),
              "cloth.obj: texture coordinates times \"uv_scale\" 1e-200 have no area; give the metres of a "
              "texture unit, or leave it out");
}

TEST_F(UvRestTest, RefusesKeysThatHaveNoEffect)
{
    EXPECT_NE(
        refusal([&] { scene_of("v 0 0 0\n", R"(, "uv_scale": 0.01)"); })
            .find("cloths[0].uv_scale: has no effect on a rest shape that is the mesh; add \"rest\": \"uv\" "
                  "or remove it"),
        std::string::npos);
    EXPECT_NE(refusal([] {
                  parse_scene(
                      R"({"toile": 1, "frames": 1, "cloths": [{"name": "c", "disc": {}, "rest": "uv"}]})",
                      "s.json");
              }).find("cloths[0].rest: only a file has texture coordinates; remove it, or write \"shape\""),
              std::string::npos);
}

/// Masses, and all else that is made of the rest shape, have the area of the texture.
TEST_F(UvRestTest, GivesTheMass)
{
    const std::string obj = grid(
        6, 6, [](double s, double t) { return posed(s, t, 1.05); }, flat);
    const Scene scene = scene_of(obj, R"(, "rest": "uv", "uv_scale": 1, "fabric": "denim")");
    const SceneCloth cloth(scene, scene.cloths[0], {}, {});
    const double mass = std::accumulate(cloth.masses().begin(), cloth.masses().end(), 0.0);
    EXPECT_NEAR(mass, cloth.state().fabric.areal_density * area_of(*cloth.rest_shape()), 1e-12);
    EXPECT_NEAR(area_of(*cloth.rest_shape()), area_of(*load(obj, R"(, "uv_scale": 1)").rest), 1e-15);
}

TEST_F(UvRestTest, OfGarmentsAsTheyAreUnwrappedIsLoadedWithAWarning)
{
    const char* const name = "garments/mh_woman_female_elegantsuit01.obj";
    const std::filesystem::path file = std::filesystem::path(TOILE_DATA_DIR) / name;
    if (!std::filesystem::exists(file))
        GTEST_SKIP() << "SKIPPED: TOILE_DATA_DIR has no " << name;
    const LoadedCloth loaded = load(bytes_of(file));
    EXPECT_NE(warnings_.find("texture coordinates are no flat copy of the mesh"), std::string::npos)
        << warnings_;
    EXPECT_NE(loaded.note.find("\"uv_scale\": "), std::string::npos);
}

} // namespace
} // namespace toile::test
