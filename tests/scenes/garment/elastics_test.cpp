#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "scenes/format/read_scene.h"
#include "scenes/surfaces/load_cloth.h"
#include "scenes/world/backend.h"
#include "scenes/world/world.h"
#include "tests/support/temporary_folder.h"

/// Cloth that elastics gather.
namespace toile::test {

using namespace scenes;

namespace {

constexpr int kColumns = 20, kRows = 2; // of a strip of 40 cm x 4 cm
constexpr double kEdge = 0.02;          // [m]

int vertex(int column, int row) { return row * (kColumns + 1) + column; }

/// The long side of a row of the strip, as an elastic.
std::string elastic(int row, double ratio, double stiffness)
{
    std::string vertices;
    for (int c = 0; c <= kColumns; ++c)
        vertices += (c == 0 ? "" : ", ") + std::to_string(vertex(c, row));
    return R"({"vertices": [)" + vertices + R"(], "ratio": )" + std::to_string(ratio) + R"(, "stiffness": )" +
           std::to_string(stiffness) + "}";
}

/// The strip hangs by a short side, its warp upwards; the lower end is column 0.
Scene hanging_strip(const std::string& elastics)
{
    return parse_scene(R"({"toile": 1, "frames": 120,
        "fabrics": {"plain": {"areal_density": 8, "stretch": {"warp": 500, "weft": 500}, "shear": 100,
                    "bend": {"warp": 0, "weft": 0}, "strain_limit": 3, "damping": 8}},
        "air": {"density": 0},
        "cloths": [{"name": "strip", "rectangle": {"size": [0.4, 0.04], "resolution": 0.02},
                    "rotate_deg": [0, 0, 90], "fabric": "plain", "elastics": [)" +
                           elastics + R"(]}],
        "attachments": [{"cloth": "strip", "select": {"vertices": [20, 41, 62]}}],
        "contact": {"self": false},
        "solver": {"integrator": "implicit-euler", "velocity_tolerance": 1e-4, "sleep": {"enabled": false}}})",
                       "strip.json");
}

/// Strain of the middle of the strip, in the mean of its long sides.
double strain_at_rest(const std::string& elastics)
{
    World world(hanging_strip(elastics));
    while (world.frame() + 1 < world.frame_count())
        EXPECT_NE(world.advance_frame().status, StepReport::Status::NonFinite);
    const std::vector<Vec3>& x = world.cloths()[0].positions;
    double length = 0.0;
    for (const int row : {0, kRows})
        length += 0.5 * (x[size_t(vertex(11, row))] - x[size_t(vertex(9, row))]).norm();
    return 0.5 * length / kEdge - 1.0;
}

std::string refusal_of(const std::string& cloth_keys, const std::string& scene_keys = "")
{
    try {
        const Scene scene = parse_scene(
            R"({"toile": 1, "frames": 1, "cloths": [{"name": "strip",
                "rectangle": {"size": [0.4, 0.04], "resolution": 0.02})" +
                cloth_keys + "}]" + scene_keys + "}",
            "strip.json");
        (void)load_cloth(scene, scene.cloths[0], {}, {});
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "";
}

} // namespace

/// Cloth and elastics side by side carry what hangs below. [N]
TEST(ElasticScene, HangsWhereClothAndElasticsBalanceTheWeight)
{
    constexpr double kCloth = 500.0 * 0.04;                   // per strain
    constexpr double kWeight = 0.5 * 8.0 * 0.4 * 0.04 * 9.81; // below the middle
    EXPECT_NEAR(strain_at_rest(""), kWeight / kCloth, 0.01 * kWeight / kCloth);
    for (const auto& [ratio, stiffness] : {std::pair{0.8, 0.5}, {0.5, 0.1}, {1.0, 4.0}}) {
        const std::string both = elastic(0, ratio, stiffness) + ", " + elastic(kRows, ratio, stiffness);
        const double expected =
            (kWeight - 2.0 * stiffness * (1.0 / ratio - 1.0)) / (kCloth + 2.0 * stiffness / ratio);
        EXPECT_NEAR(strain_at_rest(both), expected, 0.01 * expected) << ratio;
    }
}

/// Vertices are numbered as in the file, lengths those at rest.
TEST(ElasticScene, FollowsNumbersOfTheFile)
{
    const TemporaryFolder folder;
    // A loose vertex, number 1, and the corners of a square of 10 cm.
    folder.write("cloth.obj", "v 0 0 0\nv 9 9 9\nv 0.1 0 0\nv 0.1 0 0.1\nv 0 0 0.1\nf 1 5 4\nf 1 4 3\n");
    const auto load = [&](const std::string& vertices) {
        const Scene scene = parse_scene(R"({"toile": 1, "frames": 1, "cloths": [{"name": "c", "scale": 2,
            "file": "cloth.obj", "elastics": [{"vertices": )" +
                                            vertices + R"(, "ratio": 0.5, "stiffness": 3}]}]})",
                                        folder.path() / "scene.json");
        return load_cloth(scene, scene.cloths[0], {}, {}).elastics;
    };
    const auto springs = load("[0, 2, 3, 0]"); // sides, and the diagonal back
    ASSERT_EQ(springs.size(), 3u);
    const auto joins = [](const garment::Elastics::Spring& spring) {
        return std::pair(std::min(spring.a, spring.b), std::max(spring.a, spring.b));
    };
    EXPECT_EQ(joins(springs[0]), std::pair(0, 1));
    EXPECT_EQ(joins(springs[1]), std::pair(1, 2));
    EXPECT_EQ(joins(springs[2]), std::pair(0, 2));
    EXPECT_NEAR(springs[0].rest_length, 0.1, 1e-12);
    EXPECT_NEAR(springs[2].rest_length, 0.1 * std::sqrt(2.0), 1e-12);
    EXPECT_EQ(springs[0].stiffness, 3.0);
    EXPECT_THROW(load("[0, 1]"), InvalidInput) << "vertex 1 has no face";
}

TEST(ElasticScene, NamesMistakes)
{
    const auto of = [](const std::string& vertices, const std::string& more = "") {
        return R"(, "elastics": [{"vertices": )" + vertices + R"(, "ratio": 0.5, "stiffness": 3}])" + more;
    };
    EXPECT_EQ(refusal_of(of("[0, 1, 2]")), "");
    EXPECT_EQ(
        refusal_of(of("[0, 2]")),
        "strip.json: cloths[0].elastics[0].vertices[1]: no edge joins vertices 0 and 2; edges join 0 to "
        "1, 21, 22");
    EXPECT_EQ(
        refusal_of(of("[62, 63]")),
        "strip.json: cloths[0].elastics[0].vertices[1]: vertex 63 is out of range; \"strip\" has vertices 0 "
        "to 62");
    EXPECT_EQ(refusal_of(of("[4]")),
              "strip.json: cloths[0].elastics[0].vertices: an elastic runs along edges; "
              "name two vertices at least");
    EXPECT_EQ(refusal_of(R"(, "elastics": [{"vertices": [0, 1], "ratio": 1.5, "stiffness": 3}])"),
              "strip.json: cloths[0].elastics[0].ratio: 1.5 is out of range; give a number from 0.2 to 1");
    EXPECT_EQ(
        refusal_of(of("[0, 1]", R"(, "subdivide": 1)")),
        "strip.json: cloths[0].elastics: run along edges of the file, which subdivide splits; remove one "
        "of them");
    EXPECT_EQ(
        refusal_of(of("[0, 1]"), R"(, "solver": {"method": "xpbd"})"),
        "strip.json: cloths[0].elastics: are unknown to solver.method \"xpbd\"; choose another method, or "
        "remove them");
}

TEST(ElasticScene, RunsOnTheCpu)
{
    EXPECT_EQ(why_not_on_gpu(hanging_strip(elastic(0, 0.8, 1.0))), "elastics run on the CPU only");
    Scene without = hanging_strip("");
    without.solver = {};
    EXPECT_EQ(why_not_on_gpu(without), "");
}

} // namespace toile::test
