#include <cstdlib>

#include <gmock/gmock.h>

#include "export/cache_writer.h"
#include "export/point_cache.h"
#include "export/usd/usd_python.h"
#include "tests/apps/kill_points.h"
#include "tests/apps/program.h"
#include "tests/support/refusal.h"

namespace toile::test {

using namespace exports;

namespace {

using testing::HasSubstr;

class ConvertUsdTest : public FileTest {
protected:
    /// Two triangles, the second vertex at (0.1 frame, 1 / 3, rise).
    void write(const std::string& name, int frames, double rise = 0.7) const
    {
        ObjMesh mesh;
        mesh.positions = {{0, 0, 0}, {0, 1.0 / 3.0, rise}, {0, 1, 0}, {1, 1, 0}};
        mesh.polygons = {{0, 1, 2}, {1, 3, 2}};
        mesh.texture_coordinates = {{0, 0}, {1, 0}, {0, 1}};
        mesh.polygon_uvs = {{0, 1, 2}, {0, 1, 2}};
        mesh.groups = {{0, "front"}, {1, "back"}};
        CacheLayout layout = cache_layout(mesh, frames);
        layout.fps = 25.0;
        layout.start_frame = 1001.0;
        const auto writer = make_cache_writer(file(name), layout);
        for (int frame = 0; frame < frames; ++frame) {
            mesh.positions[1].x() = 0.1 * frame;
            writer->write(frame, mesh.positions);
        }
        writer->finish();
    }
    Finished convert(std::vector<std::string> arguments) const
    {
        arguments.insert(arguments.begin(), "convert");
        arguments.push_back("--quiet");
        return run_toile(arguments, folder_);
    }

    /// Says so, loudly, where the library is missing.
    static bool has_usd()
    {
        const std::string missing = refusal([] { require_usd_python("USD"); });
        if (!missing.empty())
            std::printf("SKIPPED: %s\n", missing.c_str());
        return missing.empty();
    }
};

TEST_F(ConvertUsdTest, ThroughUsdAndBackGivesTheSamePoints)
{
    if (!has_usd())
        GTEST_SKIP();
    for (const int frames : {7, 120}) {
        write("a.abc", frames);
        const std::vector<std::string> chain{"a.abc",  "b.usda", "c.abc", "d.usdc",
                                             "e.usda", "f.abc",  "g.pc2"};
        for (size_t k = 0; k + 1 < chain.size(); ++k) {
            const Finished run = convert({chain[k], chain[k + 1], "--normals"});
            EXPECT_EQ(run.exit_code, 0) << run.errors;
        }
        const PointCache first = read_cache(file("a.abc")), last = read_cache(file("f.abc"));
        ASSERT_EQ(last.frame_count(), frames);
        for (int k = 0; k < frames; ++k)
            EXPECT_EQ(last.frame(k), first.frame(k)) << k;
        EXPECT_EQ(last.mesh()->polygons, first.mesh()->polygons);
        EXPECT_EQ(last.mesh()->polygon_uvs, first.mesh()->polygon_uvs);
        EXPECT_EQ(last.mesh()->groups, first.mesh()->groups);
        EXPECT_NEAR(*last.fps(), 25.0, 1e-9);
        EXPECT_NEAR(last.start_frame(), 1001.0, 1e-9);
        write("h.pc2", frames);
        EXPECT_EQ(bytes_of(file("g.pc2")), bytes_of(file("h.pc2")));
    }
    const Finished info = run_toile({"info", "d.usdc"}, folder_);
    for (const char* line : {"mesh: /d/a/aShape", "frames: 120", "frames per second: 25", "start frame: 1001",
                             "axes: m, y up", "groups: 2"})
        EXPECT_THAT(info.output, HasSubstr(line));
}

/// The prim of the whole file is no group.
TEST_F(ConvertUsdTest, KeepsTheGroupsOfPanels)
{
    if (!has_usd())
        GTEST_SKIP();
    ObjMesh faces;
    faces.polygons = {{0, 1, 2}};
    CacheLayout layout;
    layout.frame_count = 1;
    layout.meshes = {{"front", "tee", 3, faces}, {"back", "tee", 3, faces}};
    for (const bool with_skirt : {false, true}) {
        if (with_skirt)
            layout.meshes.push_back({"skirt", "", 3, faces});
        const auto writer = make_cache_writer(file("look.usda"), layout);
        writer->write(0, std::vector<Vec3>(size_t(layout.vertex_count()), Vec3(1, 2, 3)));
        writer->finish();
        const Finished run = convert({"look.usda", "b.abc"});
        EXPECT_EQ(run.exit_code, 0) << run.errors;
        const std::string archive = file("b.abc").string();
        EXPECT_EQ(read_cache(archive + "#/tee/front/frontShape").vertex_count(), 3);
        EXPECT_EQ(read_cache(archive + "#/tee/back/backShape").vertex_count(), 3);
        EXPECT_EQ(meshes_of_cache(archive).size(), layout.meshes.size());
        if (with_skirt) {
            EXPECT_EQ(read_cache(archive + "#/skirt/skirtShape").vertex_count(), 3);
        }
    }
}

/// tests/dcc/usd_check.py compares bits, extents and velocities, and asks all validators of Pixar's library.
TEST_F(ConvertUsdTest, ValidatorsAreContent)
{
    if (!has_usd())
        GTEST_SKIP();
    const char* const chosen = std::getenv("TOILE_PYTHON");
    const std::string check =
        std::string(chosen && *chosen ? chosen : "python3") + " " TOILE_SOURCE_DIR "/tests/dcc/usd_check.py ";
    for (const int frames : {1, 7, 120}) {
        write("a.abc", frames);
        write("a.pc2", frames);
        for (const std::string name : {"b.usda", "b.usdc"}) {
            EXPECT_EQ(convert({"a.abc", name, "--normals"}).exit_code, 0);
            const Finished run = run_shell(check + name + " a.pc2", folder_);
            EXPECT_EQ(run.exit_code, 0) << run.output << run.errors;
        }
    }
    // It can fail.
    std::string text = bytes_of(file("b.usda"));
    text.erase(text.find("    defaultPrim"), text.find("    endTimeCode") - text.find("    defaultPrim"));
    temporary_.write("b.usda", text);
    const Finished run = run_shell(check + "b.usda a.pc2", folder_);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.output, HasSubstr("MissingDefaultPrim"));
}

/// USD says what its numbers are.
TEST_F(ConvertUsdTest, UnitsAndAxesOfTheFileNeedNoOption)
{
    if (!has_usd())
        GTEST_SKIP();
    write("a.abc", 3);
    EXPECT_EQ(convert({"a.abc", "b.usda", "--unit", "cm", "--up", "z"}).exit_code, 0);
    EXPECT_EQ(convert({"b.usda", "c.abc"}).exit_code, 0);
    EXPECT_LT((read_cache(file("c.abc")).frame(2)[1] - read_cache(file("a.abc")).frame(2)[1]).norm(), 1e-7);
}

TEST_F(ConvertUsdTest, AsksForPythonWithUsdInOneLine)
{
    write("a.usda", 3);
    const auto before = temporary_.snapshot();
    for (const std::string command : {"convert a.usda b.abc", "convert a.usda b.usdc", "info a.usda"}) {
        const Finished run = run_shell("TOILE_PYTHON=/nowhere/python \"$TOILE\" " + command, folder_);
        EXPECT_EQ(run.exit_code, 2) << command;
        EXPECT_EQ(run.error_lines(), 1) << run.errors;
        EXPECT_THAT(run.errors, HasSubstr("pip install usd-core"));
    }
    EXPECT_EQ(temporary_.snapshot(), before);
}

/// A kill at any moment leaves whole files: those of the earlier cache, or of the new one.
TEST_F(ConvertUsdTest, KilledAnywhereEachFileIsWhole)
{
    const std::vector<std::string> files{"skirt.usda", "skirt_clips/skirt.0000.usda",
                                         "skirt_clips/skirt.0001.usda", "skirt_clips/skirt.manifest.usda"};
    const auto contents = [&] {
        std::vector<std::string> all;
        all.reserve(files.size());
        for (const std::string& name : files)
            all.push_back(bytes_of(file(name)));
        return all;
    };
    write("skirt.pc2", 70, 0.5);
    write("skirt.obj", 1);
    write("skirt.usda", 70, 0.7);
    const std::vector<std::string> earlier = contents();
    const std::vector<std::string> command{"convert", "skirt.pc2", "skirt.usda",
                                           "--mesh",  "skirt.obj", "--quiet"};
    EXPECT_EQ(run_toile(command, folder_).exit_code, 0);
    const std::vector<std::string> later = contents();
    EXPECT_NE(earlier, later);

    bool has_ended = false;
    int kept = 0, between = 0;
    for (int n = 0; !has_ended; ++n) {
        write("skirt.usda", 70, 0.7);
        const KillResult result = kill_at(n, command, folder_);
        if (result == KillResult::Unsupported)
            GTEST_SKIP() << "this machine lets no process trace another";
        has_ended = result == KillResult::Ended;
        const std::vector<std::string> left = contents();
        for (size_t k = 0; k < files.size(); ++k)
            EXPECT_TRUE(left[k] == earlier[k] || left[k] == later[k]) << n << " " << files[k];
        if (left[0] == later[0]) {
            EXPECT_EQ(left, later) << "the root is the last that is replaced";
        }
        kept += left == earlier;
        between += left != earlier && left != later;
        ASSERT_LT(n, 1000);
    }
    EXPECT_EQ(contents(), later);
    RecordProperty("earlier_cache_whole", kept);
    RecordProperty("mixed", between);
}

} // namespace

} // namespace toile::test
