#include <gtest/gtest.h>

#include <numeric>
#include <string>

#include "core/base/error.h"
#include "scenes/format/read_scene.h"
#include "scenes/surfaces/load_cloth.h"
#include "scenes/world/backend.h"
#include "scenes/world/fabric_parts.h"
#include "scenes/world/world.h"
#include "tests/support/temporary_folder.h"

/// Cloth whose groups are of several fabrics.
namespace toile::test {

using namespace scenes;

namespace {

constexpr int kColumns = 20, kRows = 2; // of a strip of 1 m x 10 cm, in quadrilaterals

int vertex(int column, int row) { return row * (kColumns + 1) + column; }

/// The strip along X: its left half is the group "soft", its right half "stiff".
std::string strip()
{
    std::string text;
    for (int j = 0; j <= kRows; ++j)
        for (int i = 0; i <= kColumns; ++i)
            text += "v " + std::to_string(double(i) / kColumns) + " 0 " + std::to_string(-0.05 * j) + "\n";
    for (const bool stiff : {false, true}) {
        text += stiff ? "g stiff\n" : "g soft\n";
        for (int j = 0; j < kRows; ++j)
            for (int i = stiff ? kColumns / 2 : 0; i < (stiff ? kColumns : kColumns / 2); ++i)
                text += "f " + std::to_string(vertex(i, j) + 1) + " " + std::to_string(vertex(i + 1, j) + 1) +
                        " " + std::to_string(vertex(i + 1, j + 1) + 1) + " " +
                        std::to_string(vertex(i, j + 1) + 1) + "\n";
    }
    return text;
}

class GroupFabrics : public ::testing::Test {
protected:
    GroupFabrics() { folder_.write("strip.obj", strip()); }

    /// Both ends of the strip are held, the right one 2 cm further out at the end, without gravity.
    Scene pulled(const std::string& cloth_keys, const std::string& solver = R"("method": "direct")") const
    {
        std::string ends[2];
        for (int j = 0; j <= kRows; ++j)
            for (int end = 0; end < 2; ++end)
                ends[end] += (j == 0 ? "" : ", ") + std::to_string(vertex(end * kColumns, j));
        return parse_scene(
            R"({"toile": 1, "frames": 31, "gravity": [0, 0, 0], "air": {"density": 0},
                "fabrics": {"soft": {"areal_density": 0.1, "stretch": {"warp": 100, "weft": 100}, "shear": 20,
                                     "damping": 20},
                            "stiff": {"areal_density": 0.3, "stretch": {"warp": 300, "weft": 300},
                                      "shear": 20}},
                "cloths": [{"name": "strip", "file": "strip.obj", "fabric": "soft")" +
                cloth_keys + R"(}],
                "attachments": [{"cloth": "strip", "select": {"vertices": [)" +
                ends[0] + R"(]}}, {"cloth": "strip", "select": {"vertices": [)" + ends[1] +
                R"(]}, "keyframes": [{"time": 0}, {"time": 0.2, "translate": [0.02, 0, 0]}]}],
                "solver": {"integrator": "implicit-euler", "velocity_tolerance": 1e-4, )" +
                solver + "}}",
            folder_.path() / "scene.json");
    }

    std::string refusal_of(const std::string& cloth_keys, const std::string& solver = R"("method": "direct")")
    {
        try {
            const World world(pulled(cloth_keys, solver));
        } catch (const InvalidInput& error) {
            return error.what();
        }
        return "";
    }

    TemporaryFolder folder_;
};

/// k e is the same in both halves, which are as long: e = 0.04 * 300 / 400 in the soft one.
TEST_F(GroupFabrics, StretchInSeries)
{
    World world(pulled(R"(, "groups": {"stiff": {"fabric": "stiff"}})"));
    while (world.frame() + 1 < world.frame_count())
        EXPECT_EQ(world.advance_frame().status, StepReport::Status::Converged);
    for (int row = 0; row <= kRows; ++row) {
        const Vec3& middle = world.cloths()[0].positions[size_t(vertex(kColumns / 2, row))];
        EXPECT_NEAR(middle.x(), 0.5 * 1.03, 2e-4) << row;
    }
}

TEST_F(GroupFabrics, HaveTheirOwnMassAndLimit)
{
    const Scene scene = pulled(R"(, "groups": {"stiff": {"fabric": "stiff"}})");
    LoadedCloth loaded = load_cloth(scene, scene.cloths[0], {}, {});
    EXPECT_EQ(loaded.state.fabric.name, "soft");
    ASSERT_EQ(loaded.state.group_fabrics.size(), 1u);
    EXPECT_EQ(loaded.state.triangles_by_fabric()[1].size(), size_t(2 * kRows * kColumns / 2));

    const std::vector<FabricPart> parts = fabric_parts(loaded.state, loaded.rest);
    ASSERT_EQ(parts.size(), 2u);
    const std::vector<double> masses = masses_of(parts);
    EXPECT_NEAR(std::accumulate(masses.begin(), masses.end(), 0.0), 0.05 * 0.1 + 0.05 * 0.3, 1e-12);
    for (const FabricPart& part : parts) {
        EXPECT_EQ(part.rest->vertex_count(), (kColumns + 1) * (kRows + 1));
        EXPECT_NEAR(std::accumulate(part.rest->areas.begin(), part.rest->areas.end(), 0.0), 0.05, 1e-12);
    }
}

/// The same fabric by groups moves the cloth as one fabric does.
TEST_F(GroupFabrics, OfTheSameFabricMakeNoDifference)
{
    World plain(pulled("")), grouped(pulled(R"(, "groups": {"stiff": {"fabric": "soft"}})"));
    for (int frame = 0; frame < 10; ++frame) {
        plain.advance_frame();
        grouped.advance_frame();
    }
    for (size_t v = 0; v < plain.cloths()[0].positions.size(); ++v)
        EXPECT_NEAR((plain.cloths()[0].positions[v] - grouped.cloths()[0].positions[v]).norm(), 0.0, 1e-6);
}

TEST_F(GroupFabrics, AreRefusedWhereTheyCannotBe)
{
    EXPECT_NE(refusal_of(R"(, "groups": {"stif": {"fabric": "stiff"}})")
                  .find("strip.obj: has no group \"stif\" for cloth \"strip\"; did you mean \"stiff\"?"),
              std::string::npos);
    EXPECT_NE(
        refusal_of(R"(, "groups": {"stiff": {"fabric": "stif"}})").find("cloths[0].groups.stiff.fabric"),
        std::string::npos);
    EXPECT_NE(refusal_of(R"(, "groups": {"stiff": {"fabric": "stiff"}})", R"("method": "xpbd")")
                  .find("takes one fabric"),
              std::string::npos);
    EXPECT_EQ(why_not_on_gpu(pulled(R"(, "groups": {"stiff": {"fabric": "stiff"}})", R"("method": "auto")")),
              "cloth of several fabrics runs on the CPU only");
}

} // namespace
} // namespace toile::test
