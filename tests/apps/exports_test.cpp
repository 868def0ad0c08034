#include <cmath>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "export/alembic/abc_reader.h"
#include "export/byte_order.h"
#include "export/point_cache.h"
#include "tests/apps/program.h"

namespace toile::test {

using namespace exports;

namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Two cloths and a ball that moves at constant speed; what a scene's export makes of them.
class ExportsTest : public FileTest {
protected:
    /// @param exports  list of the scene
    /// @return the run, into the folder `name`
    Finished simulate(const std::string& name, const std::string& exports,
                      std::vector<std::string> options = {}) const
    {
        temporary_.write("panels.obj", "v 0 0.9 0\nv 0.1 0.9 0\nv 0.1 0.9 -0.1\nv 0 0.9 -0.1\nv 0.2 0.9 0\n"
                                       "v 0.2 0.9 -0.1\ng left\nf 1 2 3 4\ng right\nf 2 5 6 3\n");
        temporary_.write(name + ".json", R"({"toile": 1, "frames": 6, "fps": "24000/1001", "avatars": [
            {"name": "ball", "sphere": {"radius": 0.1}, "keyframes": [{"time": 0, "translate": [0, 0.2, 0]},
                {"time": 10, "translate": [10, 0.2, 0]}]}],
            "cloths": [{"name": "sheet", "file": "panels.obj"},
                       {"name": "disc", "disc": {"radius": 0.2, "resolution": 0.1}, "translate": [0, 2, 0]}],
            "export": )" + exports + "}");
        std::vector<std::string> arguments{"simulate", name + ".json", "-o", name, "--quiet"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return run_toile(arguments, folder_);
    }
    Finished simulate_well(const std::string& name, const std::string& exports,
                           const std::vector<std::string>& options = {}) const
    {
        Finished run = simulate(name, exports, options);
        EXPECT_EQ(run.exit_code, 0) << run.errors;
        return run;
    }
    /// Positions of both cloths as they are without any keys.
    std::vector<Vec3> plain(const std::string& cloth, int frame) const
    {
        const std::filesystem::path cache = file("plain/" + cloth + ".pc2");
        if (!std::filesystem::exists(cache))
            simulate_well("plain", R"([{"file": "sheet.pc2", "cloth": "sheet"},
                                       {"file": "disc.pc2", "cloth": "disc"}])");
        return read_cache(cache).frame(frame);
    }
    static void expect_near(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double tolerance)
    {
        ASSERT_EQ(a.size(), b.size());
        for (size_t v = 0; v < a.size(); ++v)
            EXPECT_LE((a[v] - b[v]).norm(), tolerance) << v;
    }
};

TEST_F(ExportsTest, AnArchiveHoldsAllClothsByDefault)
{
    simulate_well("all", R"([{"file": "all.abc"}])");
    for (const int frame : {0, 5}) {
        EXPECT_EQ(read_cache(file("all/all.abc#/sheet/sheetShape")).frame(frame), plain("sheet", frame));
        EXPECT_EQ(read_cache(file("all/all.abc#/disc/discShape")).frame(frame), plain("disc", frame));
    }
    EXPECT_EQ(meshes_of_cache(file("all/all.abc")).size(), 2u);
    EXPECT_NEAR(read_cache(file("all/all.abc#/disc/discShape")).start_frame(), 1.0, 1e-9);
    EXPECT_EQ(run_toile({"check", "all", "--scene", "all.json", "--quiet"}, folder_).exit_code, 0);
    EXPECT_EQ(run_toile({"check", "all/all.abc", "--scene", "all.json", "--quiet"}, folder_).exit_code, 0);
    const Finished picture = run_toile({"render", "all/all.abc", "--width", "64", "--height", "32"}, folder_);
    EXPECT_EQ(picture.exit_code, 0) << picture.errors;
}

TEST_F(ExportsTest, ChangesUnitAxisAndFirstFrameAndIsCertified)
{
    simulate_well("cm", R"([{"file": "a.abc", "cloth": "sheet", "unit": "cm", "up": "z", "start_frame": 1001},
                            {"file": "disc.pc2", "cloth": "disc", "unit": "cm"}])");
    const PointCache cache = read_cache(file("cm/a.abc"));
    EXPECT_NEAR(cache.start_frame(), 1001.0, 1e-6);
    std::vector<Vec3> expected = plain("sheet", 5);
    for (Vec3& x : expected)
        x = 100.0 * Vec3(x.x(), -x.z(), x.y());
    expect_near(cache.frame(5), expected, 1e-5);
    // The mesh that the PC2 plays on has its unit.
    EXPECT_NEAR(read_obj(file("cm/disc.obj")).positions[0].y(), 200.0, 1e-6);
}

TEST_F(ExportsTest, SplitsIntoPanelsAndIsCertified)
{
    simulate_well("panels", R"([{"file": "a.abc", "weld": false}])");
    const std::filesystem::path archive = file("panels/a.abc");
    EXPECT_EQ(meshes_of_cache(archive).size(), 3u);
    const std::vector<Vec3> sheet = plain("sheet", 5);
    const PointCache right = read_cache(archive.string() + "#/sheet/right/rightShape");
    expect_near(right.frame(5), {sheet[1], sheet[2], sheet[4], sheet[5]}, 0.0);
    EXPECT_EQ(read_cache(archive.string() + "#/disc/discShape").frame(5), plain("disc", 5));
    EXPECT_EQ(run_toile({"check", "panels", "--scene", "panels.json", "--quiet"}, folder_).exit_code, 0);
}

TEST_F(ExportsTest, ClosesClothWithItsThicknessAndIsCertified)
{
    simulate_well("thick", R"([{"file": "a.abc", "cloth": "disc", "thickness": true},
                               {"file": "b.abc", "cloth": "sheet", "thickness": true, "weld": false}])");
    const std::vector<Vec3> sides = read_cache(file("thick/a.abc")).frame(5), cloth = plain("disc", 5);
    ASSERT_EQ(sides.size(), 2 * cloth.size());
    for (size_t v = 0; v < cloth.size(); ++v) {
        EXPECT_LE((0.5 * (sides[v] + sides[cloth.size() + v]) - cloth[v]).norm(), 1e-6);
        EXPECT_GT((sides[v] - sides[cloth.size() + v]).norm(), 1e-4);
    }
}

/// Vectors of a property of the first mesh below an object.
std::vector<Vec3> vectors(const AbcReader& reader, const std::string& path, const std::string& name,
                          int sample)
{
    std::vector<Vec3> all;
    for (int k = 0; k < int(reader.objects().size()); ++k) {
        if (reader.path_of(k) != path)
            continue;
        const auto property = reader.find(reader.objects()[size_t(k)].properties, {".geom", name});
        const std::string bytes = reader.sample(*property, sample);
        for (size_t at = 0; at < bytes.size(); at += 12)
            all.push_back(
                Vec3(take<float>(&bytes[at]), take<float>(&bytes[at + 4]), take<float>(&bytes[at + 8])));
    }
    return all;
}

TEST_F(ExportsTest, MotionAtConstantSpeedIsEvenInSubframes)
{
    simulate_well("blur", R"([{"file": "a.abc", "avatars": true, "subframes": 3, "start_frame": 1001},
                              {"file": "disc.pc2", "cloth": "disc"}])");
    const PointCache ball = read_cache(file("blur/a.abc#/ball/ballShape"));
    ASSERT_EQ(ball.frame_count(), 16);
    EXPECT_EQ(ball.subframes(), 3);
    EXPECT_NEAR(*ball.fps(), 24000.0 / 1001.0, 1e-9);
    EXPECT_NEAR(ball.start_frame(), 1001.0, 1e-6);
    const double step = 1.0 / (3.0 * 24000.0 / 1001.0); // [m] at 1 m/s
    const AbcReader reader(file("blur/a.abc"));
    for (int k = 1; k < 16; ++k) {
        const std::vector<Vec3> before = ball.frame(k - 1), now = ball.frame(k);
        const std::vector<Vec3> velocity = vectors(reader, "/ball/ballShape", ".velocities", k);
        for (size_t v = 0; v < now.size(); ++v) {
            EXPECT_NEAR(now[v].x() - before[v].x(), step, 1e-6);
            EXPECT_NEAR((velocity[v] - Vec3(1, 0, 0)).norm(), 0.0, 1e-4);
        }
    }
    EXPECT_EQ(read_cache(file("blur/disc.pc2")).frame_count(), 6) << "whole frames beside subframes";
}

TEST_F(ExportsTest, VelocitiesAreFiniteDifferences)
{
    simulate_well("v", R"([{"file": "a.abc", "cloth": "disc"}, {"file": "b.abc", "cloth": "disc",
                            "velocities": false, "normals": true}])");
    const PointCache disc = read_cache(file("v/a.abc"));
    const AbcReader with(file("v/a.abc")), without(file("v/b.abc"));
    const double fps = 24000.0 / 1001.0;
    const std::vector<Vec3> before = disc.frame(2), after = disc.frame(4);
    const std::vector<Vec3> velocity = vectors(with, "/disc/discShape", ".velocities", 3);
    for (size_t v = 0; v < before.size(); ++v)
        EXPECT_NEAR((velocity[v] - 0.5 * fps * (after[v] - before[v])).norm(), 0.0, 1e-4);
    const auto& geometry = without.objects()[2].properties;
    EXPECT_FALSE(without.find(geometry, {".geom", ".velocities"}).has_value());
    const auto normals = without.find(geometry, {".geom", "N", ".vals"});
    ASSERT_TRUE(normals.has_value());
    EXPECT_EQ(normals->samples, 6);
    EXPECT_EQ(read_cache(file("v/b.abc")).frame(5), disc.frame(5));
}

TEST_F(ExportsTest, OptionsReplaceTheListOfTheScene)
{
    simulate_well("o", R"([{"file": "disc.pc2", "cloth": "disc"}])",
                  {"--export", "x.abc", "--export", "y/y.abc", "--unit", "cm", "--start-frame", "7"});
    EXPECT_FALSE(std::filesystem::exists(file("o/disc.pc2")));
    for (const char* name : {"o/x.abc", "o/y/y.abc"}) {
        const PointCache cache = read_cache(file(name).string() + "#/disc/discShape");
        EXPECT_NEAR(cache.start_frame(), 7.0, 1e-9);
        EXPECT_NEAR(cache.frame(0)[0].y(), 200.0, 1e-4);
    }
    const Finished lone = simulate("p", R"([{"file": "x.abc"}])", {"--unit", "cm"});
    EXPECT_EQ(lone.exit_code, 2);
    EXPECT_THAT(lone.errors, HasSubstr("--unit requires --export"));
    const Finished two = simulate("q", R"([{"file": "x.abc"}])", {"--export", "x.pc2"});
    EXPECT_EQ(two.exit_code, 2);
    EXPECT_THAT(two.errors, HasSubstr("the scene has 2 cloths; name the one to write"));
    EXPECT_FALSE(std::filesystem::exists(file("q")));
}

TEST_F(ExportsTest, CachesThatTheSceneDoesNotListAreCheckedInTheirUnit)
{
    const std::string disc = R"([{"file": "disc.pc2", "cloth": "disc"}])";
    const std::vector<std::string> in_cm{"--export-cloth", "disc", "--unit", "cm", "--start-frame", "1001"};
    std::vector<std::string> archive = in_cm, positions = in_cm;
    archive.insert(archive.begin(), {"--export", "shot.abc"});
    positions.insert(positions.begin(), {"--export", "other.pc2"});
    simulate_well("o", disc, archive);
    const Finished says_it = run_toile({"check", "o/shot.abc", "--scene", "o.json", "--quiet"}, folder_);
    EXPECT_EQ(says_it.exit_code, 0) << says_it.errors;

    simulate_well("p", disc, positions);
    std::vector<std::string> check{"check", "p/other.pc2", "--scene", "p.json", "--cloth", "disc", "--quiet"};
    EXPECT_EQ(run_toile(check, folder_).exit_code, 1) << "of metres it is a hundred times too large";
    check.insert(check.end(), {"--from-unit", "cm"});
    const Finished told = run_toile(check, folder_);
    EXPECT_EQ(told.exit_code, 0) << told.errors;
}

/// The certificate says what a run with --export wrote, which the scene does not.
TEST_F(ExportsTest, FoldersAreCheckedByWhatTheirRunWrote)
{
    const std::string disc = R"([{"file": "disc.pc2", "cloth": "disc"}])";
    simulate_well("e", disc,
                  {"--export", "shot.abc", "--unit", "cm", "--up", "z", "--thickness", "--no-weld",
                   "--attributes", "strain,gap,panel"});
    simulate_well("f", disc, {"--export", "disc.mdd", "--export-cloth", "disc", "--unit", "cm"});
    for (const std::string name : {"e", "f"}) {
        SCOPED_TRACE(name);
        const std::vector<std::string> check{"check", name, "--scene", name + ".json", "--quiet"};
        for (int time = 0; time < 2; ++time) { // the second by the certificate that the first has written
            const Finished run = run_toile(check, folder_);
            EXPECT_EQ(run.exit_code, 0) << run.errors;
        }
        const std::string cache = name == "e" ? "shot.abc" : "disc.mdd";
        EXPECT_THAT(bytes_of(file(name + "/certificate.json")), HasSubstr("\"" + cache + "\""));
        std::vector<std::string> elsewhere = check;
        elsewhere.insert(elsewhere.end(), {"-o", "elsewhere.json"});
        EXPECT_EQ(run_toile(elsewhere, folder_).exit_code, 0);
        EXPECT_THAT(bytes_of(file("elsewhere.json")), HasSubstr("\"file\": \"" + name + "/" + cache + "\""));
        std::filesystem::remove(file(name + "/certificate.json"));
        const Finished lost = run_toile(check, folder_);
        EXPECT_EQ(lost.exit_code, 2);
        EXPECT_THAT(lost.errors,
                    HasSubstr("looked for disc.pc2; name other caches, such as those of simulate "
                              "--export, one by one"));
    }
    temporary_.write("f/certificate.json", R"({"exports": [{"file": "disc.mdd", "cloth": "dics"}]})");
    const Finished other = run_toile({"check", "f", "--scene", "f.json", "--quiet"}, folder_);
    EXPECT_EQ(other.exit_code, 2);
    EXPECT_THAT(other.errors, HasSubstr("f/certificate.json: its exports do not suit the scene"));
}

TEST_F(ExportsTest, CachesOfOneNameAreToldByTheirFolders)
{
    simulate_well("n", R"([{"file": "a/c.pc2", "cloth": "sheet"},
                           {"file": "b/c.pc2", "cloth": "disc", "unit": "cm"}])");
    const std::filesystem::path certificate = file("n/b.json"); // not relative, as the cache is
    const Finished run =
        run_toile({"check", "n/b/c.pc2", "--scene", "n.json", "-o", certificate.string()}, folder_);
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_THAT(bytes_of(certificate), AllOf(HasSubstr("\"disc\""), HasSubstr("\"b/c.pc2\"")));
    std::filesystem::copy_file(file("n/b/c.pc2"), file("c.pc2"));
    const Finished unclear = run_toile({"check", "c.pc2", "--scene", "n.json"}, folder_);
    EXPECT_EQ(unclear.exit_code, 2);
    EXPECT_THAT(unclear.errors, HasSubstr("c.pc2: may be a/c.pc2 or b/c.pc2 of n.json"));
}

TEST_F(ExportsTest, MeshesToPlayOnAreSharedWhereTheyAreTheSame)
{
    simulate_well("s", R"([{"file": "disc.pc2", "cloth": "disc"},
                           {"file": "disc.mdd", "cloth": "disc", "start_frame": 5}])");
    const Finished two = simulate("t", R"([{"file": "disc.pc2", "cloth": "disc"},
                                           {"file": "disc.mdd", "cloth": "disc", "unit": "cm"}])");
    EXPECT_EQ(two.exit_code, 2);
    EXPECT_THAT(two.errors, HasSubstr("t/disc.obj"));
}

TEST_F(ExportsTest, RefusesUsdThatCouldNotBeChecked)
{
    const std::string usd_only = R"([{"file": "a.usda"}])";
    ::setenv("TOILE_PYTHON", "/nowhere/python3", 1);
    const Finished refused = simulate("u", usd_only);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.errors, HasSubstr("u/a.usda: is checked by Python with USD, which is not there"));
    EXPECT_FALSE(std::filesystem::exists(file("u")));
    simulate_well("v", usd_only, {"--no-check"});
    simulate_well("w", R"([{"file": "a.usda"}, {"file": "sheet.pc2", "cloth": "sheet"},
                           {"file": "disc.pc2", "cloth": "disc"}])");
    EXPECT_TRUE(std::filesystem::exists(file("w/certificate.json")));
    ::unsetenv("TOILE_PYTHON");
}

} // namespace
} // namespace toile::test
