#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <nlohmann/json.hpp>

#include "core/mesh/obj.h"
#include "core/mesh/triangle_mesh.h"
#include "core/mesh/weld.h"
#include "export/cache_writer.h"
#include "export/point_cache.h"
#include "scenes/meshes/shape_mesh.h"
#include "tests/apps/program.h"

namespace toile::test {

using namespace collision;
using namespace exports;
using namespace scenes;

namespace {

/// Cache of the small scene's sheet: the start positions, changed by `change(frame, positions)`.
template <typename Change>
void write_cache(const TemporaryFolder& folder, int frames, const Change& change)
{
    folder.write("drop.json", small_scene(1));
    ASSERT_EQ(run_toile({"simulate", "drop.json", "-o", ".", "--quiet"}, folder.path()).exit_code, 0);
    folder.write("drop.json", small_scene(frames));
    const std::vector<Vec3> start = read_cache(folder.path() / "sheet.pc2").frame(0);
    CacheLayout layout;
    layout.meshes.emplace_back().vertex_count = int(start.size());
    layout.frame_count = frames;
    const auto writer = make_cache_writer(folder.path() / "changed.pc2", layout);
    for (int frame = 0; frame < frames; ++frame) {
        std::vector<Vec3> positions = start;
        change(frame, positions);
        writer->write(frame, positions);
    }
    writer->finish();
}

nlohmann::json certificate(const TemporaryFolder& folder, int exit_code)
{
    const Finished run = run_toile(
        {"check", "changed.pc2", "--scene", "drop.json", "-o", "check.json", "--quiet"}, folder.path());
    EXPECT_EQ(run.exit_code, exit_code) << run.errors;
    return nlohmann::json::parse(bytes_of(folder.path() / "check.json"));
}

TEST(Check, CertifiesClothAtRestAboveABall)
{
    const TemporaryFolder folder;
    write_cache(folder, 3, [](int, std::vector<Vec3>&) {});
    const auto found = certificate(folder, 0);
    EXPECT_EQ(found["frames"], 3);
    EXPECT_EQ(found["max_penetration_m"], 0.0);
    EXPECT_NEAR(found["max_strain"], 0.0, 1e-5);
    EXPECT_EQ(found["out_of_range"], 0);
    EXPECT_TRUE(found["first_bad_frame"].is_null());
}

TEST(Check, FindsSequencesInAFolder)
{
    for (const char* name : {"sheet.obj", "SHEET.OBJ", "sheet_####.obj", "f##.obj", "a/../f.obj"}) {
        const TemporaryFolder folder;
        folder.write("s.json", small_scene(2, R"("export": [{"file": ")" + std::string(name) + R"("}])"));
        EXPECT_EQ(run_toile({"simulate", "s.json", "-o", "out", "--quiet"}, folder.path()).exit_code, 0);
        const Finished run =
            run_toile({"check", "out", "--scene", "s.json", "-o", "c.json", "--quiet"}, folder.path());
        EXPECT_EQ(run.exit_code, 0) << name << run.errors;
    }
}

TEST(Check, MeasuresDepthInsideTheBall)
{
    // Lowered by 0.08 m to y = 0.17: the middle lies 0.03 m inside the ball of radius 0.2.
    const TemporaryFolder folder;
    write_cache(folder, 3, [](int frame, std::vector<Vec3>& x) {
        for (Vec3& p : x)
            p.y() -= frame == 2 ? 0.08 : 0.0;
    });
    const auto found = certificate(folder, 1);
    EXPECT_NEAR(found["max_penetration_m"], 0.03, 1e-6);
    EXPECT_EQ(found["max_penetration_frame"], 2);
    EXPECT_EQ(found["first_bad_frame"], 2);
}

/// Two boxes of 1 m that overlap between x = 0.45 and 0.55, with their tops at y = 0.
TriangleMesh overlapping_boxes()
{
    TriangleMesh both;
    for (const double x : {0.05, 0.95}) {
        const TriangleMesh box = subdivide(weld(shape_mesh(BoxShape{Vec3::Constant(0.5)}, 0.0), 0.0).mesh, 3);
        const int first = both.vertex_count();
        for (const Vec3& p : box.positions)
            both.positions.push_back(p + Vec3(x, -0.5, 0.0));
        for (const Triangle& t : box.triangles)
            both.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    return both;
}

TEST(Check, ReportsDepthInSelfIntersectionsSeparately)
{
    const TemporaryFolder folder;
    write_cache(folder, 2, [](int, std::vector<Vec3>&) {});
    write_obj(folder.path() / "body.obj", overlapping_boxes());
    const auto found_at = [&](double x) {
        std::string scene = small_scene(2);
        const std::string ball = R"("sphere": {"radius": 0.2})";
        scene.replace(scene.find(ball), ball.size(),
                      R"("file": "body.obj", "translate": [)" + std::to_string(x) + R"(, 0.27, 0])");
        folder.write("drop.json", scene);
        return certificate(folder, 1);
    };
    // The sheet of 0.4 m lies 2 cm below the tops: on one box alone, then over the overlap too.
    const auto beside = found_at(-0.05);
    EXPECT_NEAR(beside["max_penetration_m"], 0.02, 1e-6);
    EXPECT_EQ(beside["pinches"]["max_penetration_m"], 0.0);
    EXPECT_EQ(beside["pinches"]["crossings"], 0);
    const auto folded = found_at(-0.5);
    EXPECT_GT(folded["pinches"]["max_penetration_m"], 0.01);
    // Within one box the sheet crosses the walls of the other, which are buried.
    EXPECT_GT(folded["pinches"]["crossings"], 10);
    EXPECT_EQ(folded["cloth_avatar_crossings"], 0);
    // Halfway over the edge of the left box it crosses a wall in the open.
    EXPECT_GT(found_at(0.45)["cloth_avatar_crossings"], 5);
    const Finished run =
        run_toile({"check", "changed.pc2", "--scene", "drop.json", "--penetration", "9"}, folder.path());
    EXPECT_EQ(run.exit_code, 1); // for the crossings alone
    EXPECT_EQ(nlohmann::json::parse(run.output)["first_crossing"]["b"]["name"], "ball");
    EXPECT_EQ(bytes_of(folder.path() / "changed.certificate.json"), run.output);
}

TEST(Check, MeasuresStrain)
{
    const TemporaryFolder folder;
    write_cache(folder, 2, [](int frame, std::vector<Vec3>& x) {
        for (Vec3& p : x)
            p.z() *= frame == 1 ? 1.25 : 1.0;
    });
    const auto found = certificate(folder, 1);
    EXPECT_NEAR(found["max_strain"], 0.25, 1e-5);
    EXPECT_EQ(found["first_bad_frame"], 1);
}

/// The same strain, of cloth that is attached as a whole, is what it is attached to that causes it.
/// 20 % are within the limit of jersey, but not of cotton; the place is that of the cotton, though jersey is
/// strained more.
TEST(Check, MeasuresGroupsByTheirOwnFabric)
{
    const TemporaryFolder folder;
    // Two squares side by side, each a group.
    const auto mesh = [](double first, double second) {
        std::string text;
        for (const double x : {0.0, first, first + second})
            text += "v " + std::to_string(x) + " 1 0\nv " + std::to_string(x) + " 1 -1\n";
        return text + "g a\nf 1 3 4 2\ng b\nf 3 5 6 4\n";
    };
    folder.write("rest.obj", mesh(1.0, 1.0));
    folder.write("scene.json", R"({"toile": 1, "frames": 1, "cloths": [{"name": "sheet", "file": "rest.obj",
        "fabric": "jersey", "groups": {"b": {"fabric": "cotton"}}}]})");
    for (const auto& [first, second, holds] : {std::tuple(1.2, 1.0, true), std::tuple(1.22, 1.2, false)}) {
        folder.write("sheet.obj", mesh(first, second));
        const Finished run = run_toile(
            {"check", "sheet.obj", "--scene", "scene.json", "-o", "check.json", "--quiet"}, folder.path());
        EXPECT_EQ(run.exit_code, holds ? 0 : 1) << run.errors;
        if (!holds) {
            EXPECT_NE(run.errors.find("strain 20 %, with a limit of 11.1 %, near (2."), std::string::npos)
                << run.errors;
        }
    }
}

TEST(Check, ReportsStrainBetweenAttachedVerticesApart)
{
    const TemporaryFolder folder;
    write_cache(folder, 2, [](int frame, std::vector<Vec3>& x) {
        for (Vec3& p : x)
            p.z() *= frame == 1 ? 1.25 : 1.0;
    });
    std::string scene = small_scene(2);
    scene.insert(scene.rfind('}'), R"(, "attachments": [{"cloth": "sheet", "select": {"box":
        {"lower": [-9, -9, -9], "upper": [9, 9, 9]}}}])");
    folder.write("drop.json", scene);
    const auto found = certificate(folder, 0);
    EXPECT_NEAR(found["max_attached_strain"], 0.25, 1e-5);
    EXPECT_EQ(found["max_attached_strain_frame"], 1);
    EXPECT_EQ(found["max_strain"], 0.0);
}

TEST(Check, CountsNonFiniteNumbers)
{
    const TemporaryFolder folder;
    write_cache(folder, 4, [](int frame, std::vector<Vec3>& x) {
        if (frame >= 2)
            x[5].x() = std::nan("");
    });
    const auto found = certificate(folder, 1);
    EXPECT_EQ(found["out_of_range"], 2);
    EXPECT_EQ(found["first_bad_frame"], 2);
}

TEST(Check, DoesNotHoldForFramesThatAreMissing)
{
    for (const int frames : {0, 1, 59}) {
        const TemporaryFolder folder;
        write_cache(folder, std::max(frames, 1), [](int, std::vector<Vec3>&) {});
        if (frames == 0) {
            const std::string header = bytes_of(folder.path() / "changed.pc2").substr(0, 28);
            folder.write("changed.pc2", header + std::string(4, '\0'));
        }
        folder.write("drop.json", small_scene(60));
        const auto found = certificate(folder, 1);
        EXPECT_EQ(found["holds"], false);
        EXPECT_EQ(found["frames"], frames);
        EXPECT_EQ(found["frames_expected"], 60);
        const std::string number = std::to_string(frames);
        const Finished run =
            run_toile({"check", "changed.pc2", "--scene", "drop.json", "--frames", number}, folder.path());
        EXPECT_EQ(run.exit_code, frames == 0 ? 2 : 0) << run.errors;
    }
}

/// The time to measure the depth of a triangle in a solid must not grow with its size.
TEST(Check, EndsForVerticesFarAway)
{
    for (const double far : {9e4, 1e7, 1e30, std::numeric_limits<double>::infinity()}) {
        const TemporaryFolder folder;
        write_cache(folder, 3, [&](int frame, std::vector<Vec3>& x) {
            if (frame == 1)
                x[40].x() = far;
        });
        const auto found = certificate(folder, 1);
        EXPECT_EQ(found["first_bad_frame"], 1);
        EXPECT_EQ(found["out_of_range"], far > 1e5 ? 1 : 0);
    }
}

/// A cache in centimetres is caught by its strain; in kilometres, or collapsed, by its area.
TEST(Check, DoesNotHoldForClothThatHasShrunk)
{
    const TemporaryFolder folder;
    write_cache(folder, 2, [](int frame, std::vector<Vec3>& x) {
        for (Vec3& p : x)
            p.x() *= frame == 1 ? 0.4 : 1.0;
    });
    const auto found = certificate(folder, 1);
    EXPECT_NEAR(found["min_area_ratio"], 0.4, 1e-5);
    EXPECT_EQ(found["min_area_ratio_frame"], 1);
    EXPECT_EQ(found["first_bad_frame"], 1);
    EXPECT_EQ(found["cloth_cloth_crossings"], 0);
}

TEST(Check, RefusesCachesOfAnotherRate)
{
    const TemporaryFolder folder;
    folder.write("drop.json", small_scene(3, R"("export": [{"file": "sheet.mdd", "cloth": "sheet"}])"));
    ASSERT_EQ(run_toile({"simulate", "drop.json", "-o", ".", "--quiet"}, folder.path()).exit_code, 0);
    folder.write("drop.json", small_scene(3, R"("fps": 60)"));
    const Finished run = run_toile({"check", "sheet.mdd", "--scene", "drop.json"}, folder.path());
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_NE(run.errors.find("sheet.mdd: has 30 frames a second, but the scene has 60"), std::string::npos)
        << run.errors;
}

} // namespace
} // namespace toile::test
