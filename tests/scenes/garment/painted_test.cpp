#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/base/error.h"
#include "scenes/format/read_scene.h"
#include "scenes/surfaces/load_cloth.h"
#include "scenes/world/backend.h"
#include "scenes/world/world.h"
#include "tests/support/temporary_folder.h"

/// Cloth whose stiffness and thickness are painted as vertex colours.
namespace toile::test {

using namespace scenes;

namespace {

constexpr int kColumns = 20, kRows = 2; // of a strip of 40 cm x 4 cm
constexpr double kEdge = 0.02;          // [m]

int vertex(int column, int row) { return row * (kColumns + 1) + column; }

/// The strip along X, with the colour of `colour_of(column)`.
template <typename ColourOf>
std::string strip(const ColourOf& colour_of)
{
    std::string text;
    for (int j = 0; j <= kRows; ++j)
        for (int i = 0; i <= kColumns; ++i)
            text += "v " + std::to_string(kEdge * i) + " 0 " + std::to_string(-kEdge * j) + " " +
                    colour_of(i) + "\n";
    for (int j = 0; j < kRows; ++j)
        for (int i = 0; i < kColumns; ++i)
            text += "f " + std::to_string(vertex(i, j) + 1) + " " + std::to_string(vertex(i + 1, j) + 1) +
                    " " + std::to_string(vertex(i + 1, j + 1) + 1) + " " +
                    std::to_string(vertex(i, j + 1) + 1) + "\n";
    return text;
}

const std::string kStiffness = R"("stiffness": {"channel": "red", "from": 1, "to": 4})";
const std::string kThickness = R"("thickness": {"channel": "green", "from": 0.001, "to": 0.006})";

class PaintedCloth : public ::testing::Test {
protected:
    /// Half of it is red, half green; the middle column belongs to the first half.
    PaintedCloth()
    {
        folder_.write("halves.obj",
                      strip([](int column) { return column > kColumns / 2 ? "1 0 0" : "0 1 0"; }));
        folder_.write("black.obj", strip([](int) { return "0 0 0"; }));
        folder_.write("plain.obj", strip([](int) { return ""; }));
        folder_.write("mixed.obj", strip([](int column) { return column == 2 ? "" : "1 0 0"; }));
        folder_.write("bytes.obj", strip([](int column) { return column == 3 ? "255 0 0" : "0 0 0"; }));
    }

    Scene scene(const std::string& file, const std::string& painted, const std::string& cloth,
                const std::string& more) const
    {
        return parse_scene(R"({"toile": 1, "frames": 121, "air": {"density": 0},
            "fabrics": {"plain": {"areal_density": 8, "stretch": {"warp": 500, "weft": 500}, "shear": 100,
                        "strain_limit": 3, "damping": 8}},
            "cloths": [{"name": "strip", "fabric": "plain", "file": ")" +
                               file + R"(", "painted": {)" + painted + "}" + cloth + "}" + more + "}",
                           folder_.path() / "scene.json");
    }

    /// Hangs by its stiff end, its warp upwards; the lower end is column 0.
    Scene hanging(const std::string& file, const std::string& painted) const
    {
        return scene(file, painted, R"(, "rotate_deg": [0, 0, 90])",
                     R"(], "attachments": [{"cloth": "strip", "select": {"vertices": [20, 41, 62]}}],
                        "contact": {"self": false},
                        "solver": {"integrator": "implicit-euler", "velocity_tolerance": 1e-4,
                                   "sleep": {"enabled": false}})");
    }

    std::vector<Vec3> at_rest(const Scene& scene) const
    {
        World world(scene);
        while (world.frame() + 1 < world.frame_count())
            EXPECT_NE(world.advance_frame().status, StepReport::Status::NonFinite);
        return world.cloths()[0].positions;
    }

    std::string refusal_of(const std::string& file, const std::string& painted, const std::string& cloth = "",
                           const std::string& more = "]") const
    {
        try {
            const Scene refused = scene(file, painted, cloth, more);
            (void)load_cloth(refused, refused.cloths[0], {}, {});
        } catch (const InvalidInput& error) {
            const std::string folder = folder_.path().string() + "/";
            std::string text = error.what();
            for (size_t at = text.find(folder); at != std::string::npos; at = text.find(folder))
                text.erase(at, folder.size());
            return text;
        }
        return "";
    }

    TemporaryFolder folder_;
};

double mean_strain(const std::vector<Vec3>& x, int column)
{
    double strain = 0.0;
    for (const int row : {0, kRows})
        strain += 0.5 * (x[size_t(vertex(column + 1, row))] - x[size_t(vertex(column - 1, row))]).norm() /
                  (2.0 * kEdge);
    return strain - 1.0;
}

} // namespace

/// At a distance s from the lower end the strip carries the weight below: strain = rho g s / (factor k).
TEST_F(PaintedCloth, StretchesByItsStiffness)
{
    const std::vector<Vec3> x = at_rest(hanging("halves.obj", kStiffness));
    for (const auto& [column, factor] : {std::pair{4, 1.0}, {7, 1.0}, {14, 4.0}, {17, 4.0}}) {
        const double expected = 8.0 * 9.81 * kEdge * column / (factor * 500.0);
        EXPECT_NEAR(mean_strain(x, column), expected, 0.02 * expected) << "column " << column;
    }
}

TEST_F(PaintedCloth, PaintedByOneIsThatWithoutPaint)
{
    Scene plain = hanging("black.obj", kStiffness);
    plain.cloths[0].painted.reset();
    EXPECT_EQ(at_rest(hanging("black.obj", kStiffness)), at_rest(plain));
    EXPECT_NE(at_rest(hanging("black.obj", R"("stiffness": {"channel": "red", "from": 2, "to": 1})")),
              at_rest(plain));
}

TEST_F(PaintedCloth, AveragesTrianglesAndKeepsVertices)
{
    const Scene both = hanging("halves.obj", kStiffness + ", " + kThickness);
    const ClothState state = load_cloth(both, both.cloths[0], {}, {}).state;
    ASSERT_EQ(state.stiffness.size(), state.triangles.size());
    for (size_t t = 0; t < state.triangles.size(); ++t) {
        int red = 0;
        for (const int v : state.triangles[t])
            red += v % (kColumns + 1) > kColumns / 2 ? 1 : 0;
        EXPECT_NEAR(state.stiffness[t], 1.0 + red, 1e-15);
    }
    ASSERT_EQ(state.vertex_thickness.size(), state.positions.size());
    for (int v = 0; v < int(state.positions.size()); ++v)
        EXPECT_EQ(state.vertex_thickness[size_t(v)], v % (kColumns + 1) > kColumns / 2 ? 0.001 : 0.006);
    EXPECT_EQ(state.fabric.thickness, 0.006);

    const Scene stiff = hanging("halves.obj", kStiffness);
    EXPECT_TRUE(load_cloth(stiff, stiff.cloths[0], {}, {}).state.vertex_thickness.empty());
}

/// On a floor and on other cloth, half of its own thickness is kept at each vertex.
TEST_F(PaintedCloth, LiesAsHighAsItIsThick)
{
    const std::string solver = R"(, "solver": {"integrator": "implicit-euler", "velocity_tolerance": 1e-4})";
    const std::vector<Vec3> on_floor = at_rest(
        scene("halves.obj", kThickness, R"(, "translate": [0, 0.005, 0])",
              R"(], "contact": {"gap": 0.001}, "avatars": [{"name": "floor", "plane": {}}])" + solver));
    const std::vector<Vec3> on_cloth =
        at_rest(scene("halves.obj", kThickness, R"(, "translate": [0, 0.0045, 0])",
                      R"(, {"name": "under", "fabric": "plain", "thickness": 0.001, "translate": [0.2, 0, 0],
                    "rectangle": {"size": [0.6, 0.2], "resolution": 0.025}}],
                 "attachments": [{"cloth": "under", "select": {"box": {"lower": [-1, -1, -1],
                                                                       "upper": [1, 0.001, 1]}}}])" +
                          solver));
    for (int row = 0; row <= kRows; ++row) {
        EXPECT_NEAR(on_floor[size_t(vertex(3, row))].y(), 0.001 + 0.003, 3e-4);
        EXPECT_NEAR(on_floor[size_t(vertex(17, row))].y(), 0.001 + 0.0005, 2e-4);
        EXPECT_NEAR(on_cloth[size_t(vertex(3, row))].y(), 0.0005 + 0.003, 4e-4);
        EXPECT_NEAR(on_cloth[size_t(vertex(17, row))].y(), 0.0005 + 0.0005, 3e-4);
    }
}

TEST_F(PaintedCloth, IsOnTheCpuOnly)
{
    Scene painted = hanging("halves.obj", kStiffness);
    EXPECT_EQ(why_not_on_gpu(painted), "painted cloth runs on the CPU only");
    painted.cloths[0].painted.reset();
    EXPECT_EQ(why_not_on_gpu(painted), "");
}

TEST_F(PaintedCloth, RefusesFilesWithoutColours)
{
    EXPECT_EQ(refusal_of("halves.obj", kStiffness), "");
    EXPECT_EQ(refusal_of("plain.obj", kStiffness),
              "plain.obj: has no vertex colours, by which cloth \"strip\" "
              "is painted; write each vertex as v x y z r g b");
    EXPECT_EQ(refusal_of("mixed.obj", kStiffness), "mixed.obj:3: the vertex has no colour, but others have "
                                                   "one; write each vertex as v x y z r g b");
    EXPECT_EQ(refusal_of("bytes.obj", kStiffness), "bytes.obj: vertex 3 has red 255; colours go from 0 to 1");
    EXPECT_EQ(refusal_of("bytes.obj", kThickness), "") << "its green channel is in range";
}

TEST_F(PaintedCloth, RefusesWhatHasNoMeaning)
{
    const std::string at = "scene.json: cloths[0].painted";
    EXPECT_EQ(refusal_of("halves.obj", ""),
              at + ": paints nothing; add stiffness or thickness, or remove it");
    EXPECT_EQ(refusal_of("halves.obj", R"("stiffness": {"channel": "rad", "from": 1, "to": 2})"),
              at + ".stiffness.channel: \"rad\" is unknown; write \"red\", \"green\" or \"blue\"");
    EXPECT_EQ(refusal_of("halves.obj", R"("stiffness": {"channel": "red", "from": 0, "to": 2})"),
              at + ".stiffness.from: 0 is out of range; give a number above 0 and at most 1000");
    EXPECT_EQ(refusal_of("halves.obj", R"("thickness": {"channel": "red", "from": 0.001, "to": 0.1})"),
              at + ".thickness.to: 0.1 is out of range; give a number above 0 and at most 0.05 m");
    EXPECT_EQ(refusal_of("halves.obj", R"("stiffness": {"channel": "red", "from": 1})"),
              at + ".stiffness: the key \"to\" is missing; add it");
    EXPECT_EQ(refusal_of("halves.obj", kThickness, R"(, "thickness": 0.001)"),
              at + ".thickness: is given beside the cloth's thickness; remove one");
    EXPECT_EQ(refusal_of("halves.obj", kStiffness, "",
                         R"(], "contact": {"self": false}, "solver": {"method": "vbd"})"),
              at + ": is unknown to solver.method \"vbd\"; choose another method, or remove it");
}

} // namespace toile::test
