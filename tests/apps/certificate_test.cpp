#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "export/cache_writer.h"
#include "export/point_cache.h"
#include "tests/apps/program.h"
#include "tests/volume/blocks.h"
#include "volume/mesh/msh.h"

namespace toile::test {

using namespace exports;

namespace {

using Json = nlohmann::json;

/// Two square sheets, the second `height` above the first [m], without gravity.
std::string two_sheets(double height)
{
    const auto cloth = [](const std::string& name, double y) {
        return R"({"name": ")" + name + R"(", "rectangle": {"size": [0.4, 0.4], "resolution": 0.05},
                   "translate": [0, )" +
               std::to_string(y) + ", 0]}";
    };
    return R"({"toile": 1, "frames": 3, "gravity": [0, 0, 0], "cloths": [)" + cloth("lower", 0.0) + ", " +
           cloth("upper", height) + "]}";
}

/// Rewrites a cache with the positions that `change(frame, positions)` produces.
template <typename Change>
void rewrite(const std::filesystem::path& file, const Change& change)
{
    std::vector<std::vector<Vec3>> frames;
    {
        const PointCache cache = read_cache(file);
        for (int frame = 0; frame < cache.frame_count(); ++frame)
            frames.push_back(cache.frame(frame));
    }
    CacheLayout layout;
    layout.meshes.emplace_back().vertex_count = int(frames[0].size());
    layout.frame_count = int(frames.size());
    const auto writer = make_cache_writer(file, layout);
    for (int frame = 0; frame < layout.frame_count; ++frame) {
        change(frame, frames[size_t(frame)]);
        writer->write(frame, frames[size_t(frame)]);
    }
    writer->finish();
}

Json json_in(const TemporaryFolder& folder, const char* file)
{
    return Json::parse(bytes_of(folder.path() / file));
}

TEST(Certificate, HasTheDocumentedKeys)
{
    const TemporaryFolder folder;
    folder.write("drop.json", small_scene(3));
    ASSERT_EQ(run_toile({"simulate", "drop.json", "-o", ".", "--quiet"}, folder.path()).exit_code, 0);
    const Json found = json_in(folder, "certificate.json");
    EXPECT_EQ(found["frames"], 3);
    EXPECT_EQ(found["cloth_cloth_crossings"], 0);
    EXPECT_EQ(found["cloth_avatar_crossings"], 0);
    EXPECT_TRUE(found["min_gap_m"].is_null()) << found["min_gap_m"];
    EXPECT_EQ(found["max_penetration_m"], 0.0);
    EXPECT_TRUE(found["max_penetration_point_m"].is_null());
    EXPECT_NEAR(found["max_strain"], 0.0, 0.01);
    EXPECT_TRUE(found["first_bad_frame"].is_null());
    EXPECT_EQ(found["solver"], "auto");
    EXPECT_EQ(found["version"].get<std::string>().find_first_not_of("0123456789."), std::string::npos);
    EXPECT_EQ(found["holds"], true);
    EXPECT_EQ(found["cloths"][0]["name"], "sheet");
    EXPECT_TRUE(found["cloths_left_out"].empty());
    EXPECT_TRUE(found["first_crossing"].is_null());
    EXPECT_FALSE(found.contains("soft_bodies"));
}

/// OBJ of a sheet of 0.44 m x 0.2 m.
/// @param column  width of its 8 columns in the texture; its 4 rows are 0.5 high
std::string stretched_sheet(double column)
{
    std::string obj;
    for (int j = 0; j <= 4; ++j)
        for (int i = 0; i <= 8; ++i)
            obj += "v " + std::to_string(0.055 * i) + " 1 " + std::to_string(-0.05 * j) + "\nvt " +
                   std::to_string(column * i) + " " + std::to_string(0.5 * j) + "\n";
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 8; ++i) {
            const auto corner = [&](int di, int dj) {
                const std::string k = std::to_string(9 * (j + dj) + i + di + 1);
                return std::string(" ").append(k).append("/").append(k);
            };
            obj += "f" + corner(0, 0) + corner(1, 0) + corner(1, 1) + corner(0, 1) + "\n";
        }
    return obj;
}

/// A sheet that is 1.1 times as long in space as in its texture, in decimetres. Poisson's ratio is zero, so
/// that what is held between its ends is stretched evenly.
TEST(Certificate, MeasuresStrainAgainstTheTextureThatIsTheRestShape)
{
    const TemporaryFolder folder;
    folder.write("sheet.obj", stretched_sheet(0.5));
    folder.write("rest.obj", stretched_sheet(0.53));
    const std::string ends = R"("attachments": [
        {"cloth": "sheet", "select": {"box": {"lower": [-0.001, 0, -1], "upper": [0.001, 2, 1]}}},
        {"cloth": "sheet", "select": {"box": {"lower": [0.439, 0, -1], "upper": [0.441, 2, 1]}}}])";
    const auto strain = [&](const std::string& keys) {
        folder.write(
            "sheet.json",
            R"({"toile": 1, "frames": 3, "gravity": [0, 0, 0], "fabrics": {"soft": {"strain_limit": 1.5}},
            "cloths": [{"name": "sheet", "file": "sheet.obj", "fabric": "soft")" +
                keys + "}], " + ends + "}");
        const Finished run = run_toile({"simulate", "sheet.json", "-o", "out"}, folder.path());
        EXPECT_EQ(run.exit_code, 0) << run.errors;
        EXPECT_EQ(run.errors.find("\"uv_scale\": ") != std::string::npos,
                  keys.find("uv_scale") == std::string::npos && !keys.empty())
            << run.errors;
        return json_in(folder, "out/certificate.json")["max_strain"].get<double>();
    };
    EXPECT_NEAR(strain(""), 0.0, 1e-6);
    EXPECT_NEAR(strain(R"(, "rest": "uv", "uv_scale": 0.1)"), 0.1, 1e-4);
    EXPECT_GE(strain(R"(, "rest": "uv")"), std::sqrt(1.1) - 1.0 - 1e-6) << "areas agree";
    EXPECT_NEAR(strain(R"(, "rest": "uv", "uv_scale": 0.1, "rest_file": "rest.obj")"), 0.55 / 0.53 - 1.0,
                1e-4);
}

TEST(Certificate, MeasuresTheGapOfTwoCloths)
{
    const TemporaryFolder folder;
    folder.write("two.json", two_sheets(0.003));
    ASSERT_EQ(run_toile({"simulate", "two.json", "-o", "out", "--no-check"}, folder.path()).exit_code, 0);
    rewrite(folder.path() / "out/lower.pc2", [](int frame, std::vector<Vec3>& x) {
        for (Vec3& p : x)
            p.y() = frame == 1 ? 0.001 : 0.0;
    });
    rewrite(folder.path() / "out/upper.pc2", [](int, std::vector<Vec3>& x) {
        for (Vec3& p : x)
            p.y() = 0.003;
    });
    const Finished run = run_toile({"check", "out", "--scene", "two.json", "--quiet"}, folder.path());
    EXPECT_EQ(run.exit_code, 0) << run.output << run.errors;
    const Json found = json_in(folder, "out/certificate.json");
    EXPECT_EQ(Json::parse(run.output), found);
    EXPECT_NEAR(found["min_gap_m"], 0.002, 1e-7);
    EXPECT_EQ(found["min_gap_frame"], 1);
}

TEST(Certificate, FindsClothCrossingAnotherCloth)
{
    const TemporaryFolder folder;
    folder.write("two.json", two_sheets(0.1));
    ASSERT_EQ(run_toile({"simulate", "two.json", "-o", "out", "--no-check"}, folder.path()).exit_code, 0);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out/certificate.json"));
    // In the last frame the upper sheet hangs by one corner through the lower one.
    rewrite(folder.path() / "out/upper.pc2", [](int frame, std::vector<Vec3>& x) {
        const auto is_nearer_the_corner = [](const Vec3& a, const Vec3& b) {
            return a.x() + a.z() < b.x() + b.z();
        };
        if (frame == 2)
            *std::min_element(x.begin(), x.end(), is_nearer_the_corner) = Vec3(-0.13, -0.01, -0.12);
    });
    const auto check = [&](std::vector<std::string> caches, const char* certificate, int exit_code) {
        caches.insert(caches.begin(), "check");
        caches.insert(caches.end(), {"--scene", "two.json", "--quiet", "--strain-margin", "9"});
        const Finished run = run_toile(caches, folder.path());
        EXPECT_EQ(run.exit_code, exit_code);
        EXPECT_EQ(run.error_lines(), exit_code);
        return json_in(folder, certificate);
    };
    const Json both = check({"out/upper.pc2", "out/lower.pc2"}, "out/certificate.json", 1);
    EXPECT_GE(both["cloth_cloth_crossings"], 1);
    EXPECT_EQ(both["first_bad_frame"], 2);
    EXPECT_EQ(both["min_gap_m"], 0.0);
    const Json& first = both["first_crossing"];
    EXPECT_EQ(first["frame"], 2);
    EXPECT_EQ(first["a"]["name"], "upper");
    EXPECT_EQ(first["b"]["name"], "lower");
    EXPECT_NEAR(first["point_m"][0], -0.13, 0.05);
    EXPECT_NEAR(first["point_m"][1], 0.0, 1e-6);
    EXPECT_LT(first["b"]["triangle"], 200);

    // Alone it crosses nothing, and the certificate names the cloth that was not checked.
    const Json alone = check({"out/upper.pc2"}, "out/upper.certificate.json", 0);
    EXPECT_EQ(alone["cloth_cloth_crossings"], 0);
    EXPECT_EQ(alone["cloths"].size(), 1u);
    EXPECT_EQ(alone["cloths_left_out"], Json({"lower"}));
}

TEST(Certificate, NamesTheBoneThatClothCrosses)
{
    const TemporaryFolder folder;
    const std::filesystem::path column =
        std::filesystem::path(TOILE_SOURCE_DIR) / "tests/avatars/bending_column.gltf";
    folder.write("column.json", R"({"toile": 1, "frames": 2, "gravity": [0, 0, 0],
        "avatars": [{"name": "column", "file": ")" +
                                    column.string() + R"("}],
        "cloths": [{"name": "sheet", "rectangle": {"size": [0.4, 0.4], "resolution": 0.1},
            "translate": [0, 1.95, 0]}]})");
    ASSERT_EQ(run_toile({"simulate", "column.json", "-o", "out", "--no-check"}, folder.path()).exit_code, 0);
    rewrite(folder.path() / "out/sheet.pc2", [](int frame, std::vector<Vec3>& x) {
        for (Vec3& p : x)
            p.y() -= 1.9 * frame;
    });
    const Finished run =
        run_toile({"check", "out/sheet.pc2", "--scene", "column.json", "--quiet"}, folder.path());
    EXPECT_EQ(run.exit_code, 1);
    for (const char* const part : {"with \"column\" near (", ") m, by \"base\""})
        EXPECT_NE(run.errors.find(part), std::string::npos) << run.errors;
    const Json found = json_in(folder, "out/sheet.certificate.json");
    EXPECT_EQ(found["first_crossing"]["b"]["bone"], "base");
    EXPECT_FALSE(found["first_crossing"]["a"].contains("bone"));
}

/// A sheet that lies in a ball is deepest over its centre; one corner is pulled out.
TEST(Certificate, SaysWhereClothIsDeepAndStretched)
{
    const TemporaryFolder folder;
    folder.write("ball.json", small_scene(2));
    ASSERT_EQ(run_toile({"simulate", "ball.json", "-o", ".", "--no-check"}, folder.path()).exit_code, 0);
    const Vec3 corner(-0.3, 0.1, -0.3);
    rewrite(folder.path() / "sheet.pc2", [&](int frame, std::vector<Vec3>& x) {
        for (Vec3& p : x)
            p.y() = frame == 1 ? 0.1 : 0.25;
        if (frame == 1)
            *std::min_element(x.begin(), x.end(), [](const Vec3& a, const Vec3& b) {
                return a.x() + a.z() < b.x() + b.z();
            }) = corner;
    });
    const Finished run = run_toile({"check", "sheet.pc2", "--scene", "ball.json", "--quiet"}, folder.path());
    EXPECT_EQ(run.exit_code, 1);
    const Json found = json_in(folder, "sheet.certificate.json");
    EXPECT_NEAR(found["max_penetration_m"], 0.1, 1e-3);
    const auto distance = [](const Json& point, const Vec3& from) {
        return (Vec3(point[0], point[1], point[2]) - from).norm();
    };
    EXPECT_LT(distance(found["max_penetration_point_m"], Vec3(0, 0.1, 0)), 0.05) << "within one triangle";
    EXPECT_LT(distance(found["max_strain_point_m"], corner), 0.15);
    for (const char* part : {"mm deep in an avatar near (", "%, with a limit of 11.1 %, near (-0."})
        EXPECT_NE(run.errors.find(part), std::string::npos) << run.errors;
}

TEST(Certificate, FindsClothThatAFastBodyHasGoneThrough)
{
    const TemporaryFolder folder;
    folder.write("rod.json",
                 R"({"toile": 1, "frames": 3, "avatars": [{"name": "rod", "rotate_deg": [0, 0, 90],
        "translate": [0, 0.3, 0.5], "capsule": {"radius": 0.03, "length": 1},
        "keyframes": [{"time": 0.04}, {"time": 0.05, "translate": [0, 0, -1]}]}],
        "cloths": [{"name": "curtain", "rectangle": {"size": [0.6, 0.6], "resolution": 0.05},
        "rotate_deg": [90, 0, 0], "translate": [0, 0.3, 0]}], "attachments": [{"cloth": "curtain",
        "select": {"box": {"lower": [-1, 0.58, -1], "upper": [1, 1, 1]}}}]})");
    const Finished run = run_toile({"simulate", "rod.json", "-o", ".", "--quiet"}, folder.path());
    EXPECT_EQ(run.exit_code, 1);
    const Json found = json_in(folder, "certificate.json");
    EXPECT_EQ(found["holds"], false);
    EXPECT_EQ(found["cloth_avatar_crossings"], 0);
    EXPECT_GT(found["passages"], 10);
    EXPECT_EQ(found["first_passage"]["frame"], 2);
    EXPECT_EQ(found["first_passage"]["avatar"], "rod");
}

TEST(Certificate, CoversTheFramesThatAllCachesHave)
{
    const TemporaryFolder folder;
    folder.write("two.json", two_sheets(0.1));
    ASSERT_EQ(run_toile({"simulate", "two.json", "-o", ".", "--no-check"}, folder.path()).exit_code, 0);
    ASSERT_EQ(run_toile({"simulate", "two.json", "-o", "short", "--frames", "2", "--no-check"}, folder.path())
                  .exit_code,
              0);
    std::filesystem::rename(folder.path() / "short/upper.pc2", folder.path() / "upper.pc2");
    EXPECT_EQ(run_toile({"check", ".", "--scene", "two.json", "--quiet"}, folder.path()).exit_code, 1);
    const Json found = json_in(folder, "certificate.json");
    EXPECT_EQ(found["frames"], 2);
    EXPECT_EQ(found["frames_expected"], 3);
    EXPECT_EQ(found["frames_left_out"], 1);
    EXPECT_TRUE(found["first_bad_frame"].is_null());
}

TEST(Simulate, ChecksItsOutputAtTheEnd)
{
    // The sheets start in each other, and the start pose is not repaired.
    const TemporaryFolder folder;
    std::string crossed = two_sheets(0.0);
    crossed.replace(crossed.find(R"("translate")"), 0, R"("rotate_deg": [90, 0, 20], )");
    crossed.replace(crossed.rfind('}'), 1, R"(, "contact": {"repair_start": false}})");
    folder.write("crossed.json", crossed);
    const std::vector<std::string> simulate{"simulate", "crossed.json", "-o", ".", "--quiet"};
    const Finished run = run_toile(simulate, folder.path());
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_EQ(run.error_lines(), 1) << run.errors;
    for (const char* part : {"first bad frame 0", " crossings, the first of \"", "certificate.json"})
        EXPECT_NE(run.errors.find(part), std::string::npos) << run.errors;
    EXPECT_EQ(run.output, "./lower.pc2\n./upper.pc2\n./certificate.json\n");
    EXPECT_EQ(json_in(folder, "certificate.json")["first_bad_frame"], 0);

    // Unchecked caches have no certificate, not even an old one.
    std::vector<std::string> unchecked = simulate;
    unchecked.push_back("--no-check");
    EXPECT_EQ(run_toile(unchecked, folder.path()).exit_code, 0);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "certificate.json"));
}

/// Two blocks of 2 x 2 x 2 cells in the air, "near" and "far". The vertex inside "near" is held, and moves
/// out through its right face within the first two of three frames.
void write_soft_blocks(const TemporaryFolder& folder)
{
    volume::write_msh(folder.path() / "block.msh", make_block(Vec3::Constant(0.1), {2, 2, 2}).mesh);
    folder.write("blocks.json",
                 R"({"toile": 1, "frames": 3, "gravity": [0, 0, 0], "cloths": [], "soft_bodies": [
        {"name": "far", "file": "block.msh", "translate": [1, 0, 0]}, {"name": "near", "file": "block.msh"}],
        "attachments": [
        {"cloth": "near", "select": {"box": {"lower": [-1, -1, -1], "upper": [0.01, 1, 1]}}},
        {"cloth": "near", "select": {"box": {"lower": [0.09, -1, -1], "upper": [0.11, 1, 1]}}},
        {"cloth": "near", "select": {"box": {"lower": [0.01, 0.01, 0.01], "upper": [0.09, 0.09, 0.09]}},
         "keyframes": [{"time": 0, "translate": [0, 0, 0]}, {"time": 0.0666, "translate": [0.08, 0, 0]}]}]})");
}

TEST(Certificate, ReportsTetrahedraInsideOutByBody)
{
    const TemporaryFolder folder;
    write_soft_blocks(folder);
    const Finished run = run_toile({"simulate", "blocks.json", "-o", "out"}, folder.path());
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    const Json found = json_in(folder, "out/certificate.json");
    EXPECT_EQ(found["holds"], true);
    ASSERT_EQ(found["soft_bodies"].size(), 2u);
    const Json &far = found["soft_bodies"][0], &near = found["soft_bodies"][1];
    EXPECT_EQ(far["name"], "far");
    EXPECT_EQ(far["inverted_tets"], 0);
    EXPECT_NEAR(far["volume_error"], 0.0, 1e-6);
    EXPECT_EQ(near["name"], "near");
    EXPECT_GT(near["inverted_tets"], 0);
    EXPECT_EQ(near["inverted_tets_frame"], 2);
    const std::string text =
        "\"near\" has " + near["inverted_tets"].dump() + " tetrahedra inside out in frame 2";
    EXPECT_NE(run.errors.find(text), std::string::npos) << run.errors;
    EXPECT_EQ(run.errors.find("\"far\" has"), std::string::npos) << run.errors;
    EXPECT_EQ(run.errors.find("strain"), std::string::npos) << run.errors; // of cloth only
    EXPECT_NE(run.errors.find("frame 2: tetrahedra are inside out: their body is crushed, \"near\"\n"),
              std::string::npos)
        << run.errors;
}

TEST(Certificate, MeasuresTheVolumeOfSoftBodiesFromTheirSurfaces)
{
    const TemporaryFolder folder;
    write_soft_blocks(folder);
    ASSERT_EQ(run_toile({"simulate", "blocks.json", "-o", "out", "--no-check"}, folder.path()).exit_code, 0);
    std::vector<Vec3> start;
    rewrite(folder.path() / "out/near.pc2", [&](int frame, std::vector<Vec3>& x) {
        if (frame == 0)
            start = x;
        x = start;
        for (Vec3& p : x)
            p *= frame == 1 ? 0.9 : 1.0;
    });
    const Finished run = run_toile({"check", "out/near.pc2", "--scene", "blocks.json"}, folder.path());
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_NE(run.errors.find("volume off by 27.1 % at most, that of \"near\" in frame 1"), std::string::npos)
        << run.errors;
    const Json found = json_in(folder, "out/near.certificate.json");
    const Json &far = found["soft_bodies"][0], &near = found["soft_bodies"][1];
    EXPECT_TRUE(far["volume_error"].is_null());
    EXPECT_NEAR(near["volume_error"], 1.0 - 0.9 * 0.9 * 0.9, 1e-5);
    EXPECT_EQ(near["volume_error_frame"], 1);
    EXPECT_TRUE(near["inverted_tets"].is_null()) << "caches hold surfaces only";
    EXPECT_TRUE(near["inverted_tets_frame"].is_null());
}

} // namespace
} // namespace toile::test
