#include "tests/apps/program.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <regex>

#include <nlohmann/json.hpp>

#include <signal.h>
#include <sys/resource.h>

#include "core/mesh/obj.h"
#include "export/point_cache.h"
#include "tests/volume/blocks.h"
#include "volume/mesh/msh.h"

namespace toile::test {

using namespace exports;

namespace {

TEST(Simulate, WritesOneCachePerClothAndTheMeshItPlaysOn)
{
    const TemporaryFolder folder;
    folder.write("drop.json", small_scene(4));
    const Finished run = run_toile({"simulate", "drop.json", "--quiet"}, folder.path());
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_EQ(run.output, "out/drop/sheet.pc2\nout/drop/certificate.json\n");
    EXPECT_EQ(run.errors, "");

    const PointCache cache = read_cache(folder.path() / "out/drop/sheet.pc2");
    EXPECT_EQ(cache.frame_count(), 4);
    const ObjMesh mesh = read_obj(folder.path() / "out/drop/sheet.obj");
    ASSERT_EQ(int(mesh.positions.size()), cache.vertex_count());
    // Sample 0 is the start: flat at 0.25 m. The cloth then falls.
    for (const Vec3& p : cache.frame(0))
        EXPECT_NEAR(p.y(), 0.25, 1e-6);
    EXPECT_LT(cache.frame(3)[0].y(), 0.249);
}

TEST(Simulate, ObeysOptionsAndTheExportList)
{
    const TemporaryFolder folder;
    folder.write("drop.json", small_scene(9, R"("export": [{"file": "a/b.mdd"}, {"file": "frames.obj"}])"));
    const Finished run = run_toile({"simulate", "drop.json", "-o", "there", "--frames", "3", "--threads", "1",
                                    "--solver", "direct", "--outer", "anderson", "--report", "run.json"},
                                   folder.path());
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_EQ(run.output, "there/a/b.mdd\nthere/frames.obj\nthere/certificate.json\n");
    EXPECT_NE(run.errors.find("certificate holds for 3 frames"), std::string::npos) << run.errors;
    EXPECT_NE(run.errors.find("frame 3/3 (100 %)"), std::string::npos) << run.errors;
    EXPECT_EQ(read_cache(folder.path() / "there/a/b.mdd").frame_count(), 3);
    EXPECT_EQ(read_cache(folder.path() / "there/frames_####.obj").frame_count(), 3);

    const auto report = nlohmann::json::parse(bytes_of(folder.path() / "run.json"));
    EXPECT_EQ(report["outcome"], "complete");
    EXPECT_EQ(report["settings"]["frames"], 3);
    EXPECT_EQ(report["settings"]["threads"], 1);
    EXPECT_EQ(report["settings"]["method"], "direct");
    EXPECT_EQ(report["settings"]["outer"], "anderson");
    ASSERT_EQ(report["frames"].size(), 2u); // sample 0 costs no step
    EXPECT_EQ(report["frames"][0]["frame"], 1);
    EXPECT_EQ(report["frames"][0]["steps"], 4);
    EXPECT_GT(report["peak_memory_bytes"], 1e6);
    EXPECT_FALSE(report["stages"].empty());
    EXPECT_FALSE(report["start"]["repaired"]) << "nothing was wrong";
}

TEST(Simulate, ReportsTheRepairOfTheStartPose)
{
    const TemporaryFolder folder;
    folder.write("sunk.json", R"({"toile": 1, "frames": 1,
        "avatars": [{"name": "ball", "sphere": {"radius": 0.1}}],
        "cloths": [{"name": "sheet", "rectangle": {"size": [0.3, 0.3], "resolution": 0.03},
                    "translate": [0, 0.09, 0]}]})");
    const Finished run =
        run_toile({"simulate", "sunk.json", "--quiet", "--report", "run.json"}, folder.path());
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_NE(run.errors.find("toile: start pose: "), std::string::npos) << run.errors;
    EXPECT_NE(run.errors.find("inside avatars, up to 10.0 mm deep; "), std::string::npos) << run.errors;
    EXPECT_NE(run.errors.find("crossing avatars; 0 crossings of cloth with cloth"), std::string::npos)
        << run.errors;
    EXPECT_NE(run.errors.find("nothing remains"), std::string::npos) << run.errors;

    const auto start = nlohmann::json::parse(bytes_of(folder.path() / "run.json"))["start"];
    EXPECT_TRUE(start["repaired"]);
    EXPECT_EQ(start["places_inside_remaining"], 0);
    EXPECT_GT(start["avatar_crossings"], 0);
    ASSERT_EQ(start["places"].size(),
              start["places_inside"].get<size_t>() + start["avatar_crossings"].get<size_t>());
    EXPECT_EQ(start["places"][0]["kind"], "inside_avatar");
    EXPECT_EQ(start["places"][0]["other"], "ball");
    EXPECT_EQ(start["places"][0]["repaired"], true);
    EXPECT_EQ(start["places"][0]["position_m"].size(), 3u);
}

/// Limits the size of files of this process and its children during its lifetime [bytes].
class FileLimit {
public:
    explicit FileLimit(rlim_t bytes) : handler_(::signal(SIGXFSZ, SIG_IGN))
    {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileLimit()
    {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        ::signal(SIGXFSZ, handler_);
    }
    FileLimit(const FileLimit&) = delete;
    FileLimit& operator=(const FileLimit&) = delete;

private:
    rlimit before_{};
    void (*handler_)(int);
};

TEST(Simulate, NamesThePartialCacheWhenWritingFails)
{
    const TemporaryFolder folder;
    folder.write("drop.json", small_scene(60));
    Finished run;
    {
        const FileLimit limit(8192);
        run = run_toile({"simulate", "drop.json", "-o", ".", "--quiet"}, folder.path());
    }
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_EQ(run.output, "./sheet.partial.pc2\n");
    EXPECT_EQ(run.error_lines(), 1) << run.errors;
    EXPECT_NE(run.errors.find("toile: error: failed at frame "), std::string::npos) << run.errors;
    EXPECT_NE(run.errors.find("sheet.partial.pc2: writing broke off"), std::string::npos) << run.errors;
    EXPECT_GE(read_cache(folder.path() / "sheet.partial.pc2").frame_count(), 1);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "sheet.pc2"));
}

TEST(Simulate, KeepsAReadableCacheWhenInterrupted)
{
    const TemporaryFolder folder;
    folder.write("drop.json", small_scene(1000000));
    folder.write("sheet.pc2", "an earlier cache");
    const std::filesystem::path partial = folder.path() / "sheet.partial.pc2";
    const Finished run = run_and_interrupt({"simulate", "drop.json", "-o", "."}, folder.path(), partial);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_EQ(run.error_lines(), 1) << run.errors;
    EXPECT_NE(run.errors.find("interrupted at frame"), std::string::npos) << run.errors;
    EXPECT_EQ(bytes_of(folder.path() / "sheet.pc2"), "an earlier cache");
    EXPECT_GE(read_cache(partial).frame_count(), 1);
}

/// On a terminal, within seconds.
TEST(Simulate, TellsWhereALongFrameIs)
{
    const TemporaryFolder folder;
    folder.write("long.json",
                 R"({"toile": 1, "frames": 2, "solver": {"substeps": 1000, "velocity_tolerance": 1e-6,
        "sleep": {"enabled": false}}, "cloths": [{"name": "sheet", "rectangle": {"size": [0.4, 0.4],
        "resolution": 0.01}}], "attachments": [{"cloth": "sheet", "select": {"vertices": [0]}}]})");
    if (run_shell("script -qec true /dev/null", folder.path()).exit_code != 0)
        GTEST_SKIP() << "no program `script` here, which makes a terminal";
    const Finished run =
        run_shell("timeout 6 script -qec \"'$TOILE' simulate long.json -o out\" /dev/null", folder.path());
    EXPECT_TRUE(
        std::regex_search(run.output, std::regex(R"(frame 1/2 .*the next: \d+ %, step \d+, iteration \d)")))
        << run.output;
}

TEST(Render, TakesAPictureASheetAndAFolder)
{
    const TemporaryFolder folder;
    folder.write("drop.json", small_scene(5));
    ASSERT_EQ(run_toile({"simulate", "drop.json", "-o", ".", "--quiet"}, folder.path()).exit_code, 0);
    const auto is_png = [&](const char* file) {
        return bytes_of(folder.path() / file).rfind("\x89PNG", 0) == 0;
    };

    EXPECT_EQ(run_toile({"render", "drop.json", "--quiet"}, folder.path()).exit_code, 0);
    EXPECT_TRUE(is_png("drop.png"));
    EXPECT_EQ(
        run_toile({"render", "sheet.pc2", "--scene", "drop.json", "-o", "last.png"}, folder.path()).exit_code,
        0);
    EXPECT_TRUE(is_png("last.png"));
    EXPECT_NE(bytes_of(folder.path() / "last.png"), bytes_of(folder.path() / "drop.png"));
    EXPECT_EQ(run_toile({"render", "sheet.pc2", "--scene", "drop.json", "-o", "all.png", "--sheet", "2",
                         "--frames", "0:4:2"},
                        folder.path())
                  .exit_code,
              0);
    EXPECT_TRUE(is_png("all.png"));
    EXPECT_EQ(run_toile({"render", "sheet.pc2", "--scene", "drop.json", "-o", "many", "--frames", "1:3"},
                        folder.path())
                  .exit_code,
              0);
    EXPECT_TRUE(is_png("many/frame_0001.png"));
    EXPECT_TRUE(is_png("many/frame_0003.png"));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "many/frame_0004.png"));
}

TEST(Info, PrintsNothingOfASceneWhoseMeshIsMissing)
{
    const TemporaryFolder folder;
    folder.write("jelly.json", R"({"toile": 1, "frames": 1, "cloths": [], "soft_bodies": [
        {"name": "jelly", "file": "none.msh", "young": 250, "density": 900}]})");
    const Finished run = run_toile({"info", "jelly.json"}, folder.path());
    EXPECT_NE(run.exit_code, 0);
    EXPECT_EQ(run.output, "");
    EXPECT_NE(run.errors.find("none.msh"), std::string::npos) << run.errors;
}

TEST(Info, DescribesEveryKindOfFile)
{
    const TemporaryFolder folder;
    folder.write("drop.json", small_scene(2));
    ASSERT_EQ(run_toile({"simulate", "drop.json", "-o", ".", "--quiet"}, folder.path()).exit_code, 0);
    const auto says = [&](const char* file, const char* what) {
        const Finished run = run_toile({"info", file}, folder.path());
        EXPECT_EQ(run.exit_code, 0) << run.errors;
        EXPECT_NE(run.output.find(what), std::string::npos) << run.output;
    };
    says("drop.json", "cloth: sheet, cotton");
    says("drop.json", "on a GPU: 1 quadrature table for 1 cloth or body of");
    volume::write_msh(folder.path() / "block.msh", make_block(Vec3::Constant(0.1), {2, 2, 2}, 0.0).mesh);
    folder.write("jelly.json", R"({"toile": 1, "frames": 1, "cloths": [], "soft_bodies": [
        {"name": "jelly", "file": "block.msh", "young": 250, "density": 900}]})");
    says("jelly.json", "soft body: jelly, block.msh, 250 Pa, 900 kg/m^3\n");
    says("jelly.json", "simulated vertices: 27\n");
    says("jelly.json", "memory of the GPU: ");
    folder.write("nod.bvh",
                 "HIERARCHY\nROOT hips\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Yrotation Xrotation\n"
                 "JOINT head\n{\nOFFSET 0 60 0\nCHANNELS 3 Zrotation Yrotation Xrotation\nEnd Site\n"
                 "{\nOFFSET 0 20 0\n}\n}\n}\nMOTION\nFrames: 3\nFrame Time: 0.25\n0 0 0 0 0 0\n"
                 "0 0 0 0 0 9\n0 0 0 0 0 0\n");
    says("nod.bvh", "joints: 3 (hips, head, EndSite_head)\nclip: \"Motion\", 0.500000 s\n");
    says("sheet.pc2", "frames: 2");
    says("sheet.obj", "pieces: 1");
    says("sheet.obj", "(open)");
    folder.write("SHEET.OBJ", bytes_of(folder.path() / "sheet.obj"));
    says("SHEET.OBJ", "pieces: 1");
    folder.write("two_sided.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 2\n");
    says("two_sided.obj", "as cloth: left out 1 face with the corners of others");
    says("two_sided.obj", "border edges: 3 (open)");
    const std::string textured = "v 0 0 0\nv .1 0 0\nv 0 .1 0\nvt 0 0\nvt 5 0\nvt 0 5\nf 1/1 2/2 3/3\n";
    folder.write("textured.obj", textured);
    says("textured.obj", "as rest shape: \"uv_scale\": 0.02 makes the areas at rest and of the mesh equal");
    folder.write("mixed.obj", textured + "v .1 .1 0\nf 2 4 3\n");
    says("mixed.obj", "not usable as rest shape: mixed.obj:9: the face has no texture coordinates");
    EXPECT_EQ(run_toile({"info", "sheet.obj"}, folder.path()).output.find("rest shape"), std::string::npos);
    says("two_sided.obj", "pieces: 1\nborder loops: 0\nEuler characteristic: 2\n");
    says("two_sided.obj", "as cloth: 1 piece, 1 border loop, Euler characteristic 1\n");
    folder.write("branching.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\ng a\nf 1 2 3\ng b\nf 1 2 4\n"
                                  "g a\nf 1 2 5\nl 3 4 5\n");
    says("branching.obj", "groups: 2 (a, b)\nlines: 2\npieces: 1\n");
    says("branching.obj", "edges of three or more triangles: 1\n");
    folder.write("points.obj", "v 0 0 0\n");
    says("points.obj", "not usable as cloth: points.obj: the mesh has no triangle");
    folder.write("tet.vtk",
                 "# vtk DataFile Version 2.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n"
                 "0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n");
    says("tet.vtk", "triangles of the surface: 4\npieces: 1\nborder loops: 0\nEuler characteristic: 2\n");
}

/// A corner of a cube of 2 m, whose tetrahedron is inside out in the file, and a flatter one on its face.
TEST(Info, MeasuresTetrahedra)
{
    const TemporaryFolder folder;
    folder.write("two.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n1 0 0 0\n2 2 0 0\n3 0 2 0\n"
                            "4 0 0 2\n5 0 0 -1\n6 9 9 9\n$EndNodes\n$Elements\n2\n1 4 2 0 1 1 3 2 4\n"
                            "2 4 2 0 1 1 3 2 5\n$EndElements\n");
    folder.write("two.vtk",
                 "# vtk DataFile Version 2.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n"
                 "0 0 0 2 0 0 0 2 0 0 0 2 0 0 -1\nCELLS 2 10\n4 0 2 1 3\n4 0 2 1 4\n"
                 "CELL_TYPES 2\n10\n10\n");
    const double right = std::sqrt(5.0), diagonal = std::sqrt(8.0);
    for (const char* file : {"two.msh", "two.vtk"}) {
        const Finished run = run_toile({"info", file, "--json"}, folder.path());
        ASSERT_EQ(run.exit_code, 0) << run.errors;
        const auto found = nlohmann::json::parse(run.output);
        EXPECT_EQ(found["file"], file);
        EXPECT_EQ(found["vertices"], 5) << "no tetrahedron has the sixth";
        EXPECT_EQ(found["tetrahedra"], 2);
        EXPECT_EQ(found["inverted"], 1);
        EXPECT_NEAR(found["volume"], 8.0 / 6.0 + 4.0 / 6.0, 1e-12);
        // Between the faces through the three axes' ends and through the plane z = 0.
        EXPECT_NEAR(found["smallest_dihedral_deg"],
                    std::atan(1.0 / std::sqrt(2.0)) * 180.0 / std::numbers::pi, 1e-9);
        EXPECT_NEAR(found["mean_edge"], (3 * 2 + 3 * diagonal + 2 * 2 + 1 + diagonal + 2 * right) / 12.0,
                    1e-12);
        EXPECT_EQ(found["surface"]["vertices"], 5);
        EXPECT_EQ(found["surface"]["triangles"], 6);
        EXPECT_EQ(found["lower"], nlohmann::json({0.0, 0.0, -1.0}));
        EXPECT_EQ(found["upper"], nlohmann::json({2.0, 2.0, 2.0}));
        const std::string text = run_toile({"info", file}, folder.path()).output;
        for (const char* line : {"tetrahedra: 2\n", "tetrahedra inside out: 1 (they are turned when read)\n",
                                 "smallest dihedral angle: 35.3 degrees\n", "volume: 2\n",
                                 "extent: x 0 to 2, y 0 to 2, z -1 to 2\n"})
            EXPECT_NE(text.find(line), std::string::npos) << text;
    }
}

TEST(Schema, PrintsJsonAndTables)
{
    const TemporaryFolder folder;
    const Finished schema = run_toile({"schema"}, folder.path());
    EXPECT_EQ(nlohmann::json::parse(schema.output)["title"], "Toile scene");
    EXPECT_NE(run_toile({"schema", "--tables"}, folder.path()).output.find("| `fabric` |"),
              std::string::npos);
}

TEST(Help, ExitsWithoutError)
{
    const TemporaryFolder folder;
    for (const std::vector<std::string>& arguments :
         std::vector<std::vector<std::string>>{{"--help"}, {"--version"}, {"simulate", "--help"}}) {
        const Finished run = run_toile(arguments, folder.path());
        EXPECT_EQ(run.exit_code, 0);
        EXPECT_EQ(run.errors, "");
        EXPECT_FALSE(run.output.empty());
    }
}

TEST(Version, NamesCommitConfigurationAndBackends)
{
    const TemporaryFolder folder;
    const std::string output = run_toile({"--version"}, folder.path()).output;
    const std::regex expected("toile \\d+\\.\\d+\\.\\d+ \\(commit ([0-9a-f]{7,}\\+?|unknown), \\w+\\)\n"
                              "backends: cpu(, cuda \\d+\\.\\d+ \\(.+\\))?\n");
    EXPECT_TRUE(std::regex_match(output, expected)) << output;
}

} // namespace
} // namespace toile::test
