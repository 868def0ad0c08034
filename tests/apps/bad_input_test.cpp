#include <gtest/gtest.h>

#include "tests/apps/program.h"

namespace toile::test {

namespace {

struct BadRun {
    std::vector<std::string> arguments;
    std::vector<std::string> says; ///< file, location and remedy
};

/// Writes NAME.obj and NAME.json, whose only cloth it is.
void write_cloth(const TemporaryFolder& folder, const std::string& name, const std::string& obj)
{
    folder.write(name + ".obj", obj);
    folder.write(name + ".json",
                 R"({"toile": 1, "frames": 3, "cloths": [{"name": "a", "file": ")" + name + R"(.obj"}]})");
}

/// Writes NAME.json, whose only soft body is of one triangle, with these keys.
void write_soft_body(const TemporaryFolder& folder, const std::string& name, const std::string& keys)
{
    folder.write("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n");
    folder.write(name + ".json", R"({"toile": 1, "frames": 3, "cloths": [],
"soft_bodies": [{"name": "b", "file": "triangle.obj", )" +
                                     keys + "}]}");
}

/// Writes the skinned column of the avatar tests with a joint that points to a missing node.
void write_body_without_bone(const TemporaryFolder& folder)
{
    std::string body =
        bytes_of(std::filesystem::path(TOILE_SOURCE_DIR) / "tests/avatars/bending_column.gltf");
    const std::string joints = R"("joints": [ 1, 2 ])";
    const size_t at = body.find(joints);
    ASSERT_NE(at, std::string::npos);
    folder.write("bone.gltf", body.replace(at, joints.size(), R"("joints": [ 1, 9 ])"));
    folder.write("bone.json", R"({"toile": 1, "frames": 3, "cloths": [{"name": "a", "disc": {}}],
                                  "avatars": [{"name": "b", "file": "bone.gltf", "clip": "bend"}]})");
}

/// Fills the folder with the files of the runs below: a good scene with its cache, and broken ones.
void fill(const TemporaryFolder& folder)
{
    folder.write("good.json", small_scene(3));
    ASSERT_EQ(run_toile({"simulate", "good.json", "-o", ".", "--quiet"}, folder.path()).exit_code, 0);
    folder.write("syntax.json", "{\n \"toile\": 1,\n");
    folder.write("key.json", small_scene(3, R"("framse": 3)"));
    folder.write("range.json", small_scene(0));
    write_cloth(folder, "mesh", "v 0 0 0\nv 1 0 zero\n");
    write_cloth(folder, "nan", "v 0 0 0\nv 1 nan 0\n");
    write_cloth(folder, "empty", "v 0 0 0\n");
    write_cloth(folder, "flat", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    write_cloth(folder, "archive", std::string("PK\x03\x04\0\0", 6));
    folder.write("points.fbx", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                               "property float z\nend_header\n0 0 0\n");
    folder.write("points.json", R"({"toile": 1, "frames": 3, "cloths": [{"name": "a", "disc": {}}],
                                    "avatars": [{"name": "b", "file": "points.fbx"}]})");
    folder.write("tets.vtk", "# vtk DataFile Version 2.0\nt\nASCII\nDATASET POLYDATA\n");
    folder.write("tets.json", R"({"toile": 1, "frames": 3, "cloths": [],
                                  "solids": [{"name": "b", "file": "tets.vtk"}]})");
    write_soft_body(folder, "hot", R"("cell": 0.1, "young": 1e400)");
    write_soft_body(folder, "incompressible", R"("cell": 0.1, "poisson": 0.5)");
    write_soft_body(folder, "unfilled", R"("young": 1e4)");
    write_soft_body(folder, "open", R"("cell": 0.1)");
    folder.write("nan.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 nan 0\n$EndNodes\n");
    folder.write("nan_tets.json", R"({"toile": 1, "frames": 3, "cloths": [],
                                      "soft_bodies": [{"name": "b", "file": "nan.msh"}]})");
    write_body_without_bone(folder);
    folder.write("weightless.json", small_scene(3, R"("fabrics": {"ghost": {"areal_density": 0}})"));
    folder.write("missing.json",
                 R"({"toile": 1, "frames": 3, "cloths": [{"name": "a", "file": "none.obj"}]})");
    folder.write("cut.pc2", bytes_of(folder.path() / "sheet.pc2").substr(0, 200));
    folder.write("coarse.json", R"({"toile": 1, "frames": 3, "cloths": [{"name": "sheet", "disc": {}}]})");
    folder.write("body.json", R"({"toile": 1, "frames": 3, "cloths": [{"name": "a", "disc": {}}],
                                  "avatars": [{"name": "b", "mannequin": {}, "clip": "wolk"}]})");
    folder.write("text.xyz", "?");
    folder.write("deep.json",
                 R"({"toile": 1, "frames": )" + std::string(100'000, '[') + std::string(100'000, ']') + "}");
    folder.write("huge.obj", "v 0 1e150 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n");
    folder.write("huge.json", R"({"toile": 1, "frames": 3, "cloths": [{"name": "sheet", "disc": {}}],
                                  "avatars": [{"name": "b", "file": "huge.obj"}]})");
    write_cloth(folder, "wide", "v 0 1e18 0\nv 1e18 0 0\nv 0 0 1e18\nf 1 2 3\n");
    std::string infinite = bytes_of(folder.path() / "sheet.pc2");
    infinite.replace(infinite.size() - 4, 4, std::string("\x00\x00\x80\x7f", 4));
    folder.write("infinite.pc2", infinite);
    std::filesystem::create_directory(folder.path() / "bare");
    folder.write("file", "not a folder");
    std::filesystem::create_directory(folder.path() / "other");
    folder.write("other/good.json", small_scene(3));
    folder.write("second.json", small_scene(3));
    folder.write("slow.json", small_scene(3, R"("solver": {"method": "xpbd"})"));
}

const std::vector<BadRun> kBadRuns{
    {{}, {"subcommand is required", "toile --help"}},
    {{"simulte"}, {"simulte", "did you mean \"simulate\"?"}},
    {{"simulate"}, {"scene is required", "toile simulate --help"}},
    {{"simulate", "good.json", "--frmes", "3"}, {"--frmes", "did you mean --frames?"}},
    {{"simulate", "good.json", "--frames", "many"}, {"--frames", "many"}},
    {{"simulate", "good.json", "--frames", "0"}, {"--frames", "0", "from 1 to 1000000"}},
    {{"simulate", "good.json", "--solver", "magic"}, {"--solver", "magic", "direct"}},
    {{"simulate", "good.json", "--outer", "magic"}, {"--outer", "magic", "anderson"}},
    {{"simulate", "good.json", "--backend", "magic"}, {"--backend", "magic", "cuda"}},
    {{"simulate", "good.json", "--devices", "0,1"}, {"--devices: 0,1", "backend cpu", "--backend cuda"}},
    {{"simulate", "good.json", "--backend", "cuda", "--devices", "0,x"}, {"--devices", "\"x\"", "e.g. 0,1"}},
    {{"simulate", "good.json", "--backend", "auto", "--devices", "1,1"}, {"--devices", "1 appears twice"}},
    {{"simulate", "good.json", "--backend", "auto", "--devices", ""}, {"--devices", "empty", "e.g. 0,1"}},
    {{"simulate", "good.json", "-o", "file/there"}, {"file/there"}},
    {{"simulate", "good.json", "other/good.json"}, {"other/good.json", "out/good", "a name of its own"}},
    {{"simulate", "good.json", "good.json", "-o", "o"}, {"good.json", "o/good", "each scene once"}},
    {{"simulate", "good.json", "second.json", "-o", "file"}, {"file/good: ", "/file is no folder"}},
    {{"simulate", "good.json", "second.json", "--report", "file"},
     {"file/good.json: ", "/file is no folder"}},
    {{"simulate", "good.json", "none.json"}, {"none.json", "check the path"}},
    {{"simulate", "good.json", "slow.json", "--backend", "cuda"},
     {"slow.json", "\"xpbd\" runs on the CPU only"}},
    {{"simulate", "good.json", "--report", "."}, {".", "is a folder", "name a file"}},
    {{"simulate", "good.json", "--report", "file/run.json"}, {"file/run.json", "is no folder"}},
    {{"simulate", "none.json"}, {"none.json", "check the path"}},
    {{"simulate", "."}, {"is a folder", "name a scene file"}},
    {{"simulate", "syntax.json"}, {"syntax.json:3:1", "not valid JSON"}},
    {{"simulate", "key.json"}, {"key.json: framse", "did you mean \"frames\"?"}},
    {{"simulate", "range.json"}, {"range.json: frames: 0", "from 1 to 1000000"}},
    {{"simulate", "mesh.json"}, {"mesh.obj:2", "'zero'", "decimal number"}},
    {{"simulate", "nan.json"}, {"nan.obj:2", "'nan'", "decimal number"}},
    {{"simulate", "empty.json"}, {"empty.obj", "no triangle", "at least one face"}},
    {{"simulate", "flat.json"}, {"flat.obj:4: the face", "no area", "remove it or merge"}},
    {{"simulate", "archive.json"}, {"archive.obj: is no OBJ", "binary"}},
    {{"simulate", "points.json"}, {"points.fbx: can't be read"}},
    {{"simulate", "tets.json"}, {"tets.vtk:4", "'polydata'", "UNSTRUCTURED_GRID"}},
    {{"simulate", "hot.json"}, {"hot.json:2:", "1e400", "number"}},
    {{"simulate", "incompressible.json"}, {"incompressible.json: soft_bodies[0].poisson: 0.5", "0 to 0.49"}},
    {{"simulate", "unfilled.json"}, {"unfilled.json: soft_bodies[0]", "cell"}},
    {{"simulate", "open.json"}, {"triangle.obj: the edge from (0, 0, 0) to (", "give a closed surface"}},
    {{"simulate", "nan_tets.json"}, {"nan.msh:6", "nan"}},
    {{"simulate", "bone.json"}, {"bone.gltf", "index 9 is out of bounds"}},
    {{"simulate", "weightless.json"}, {"weightless.json: fabrics.ghost.areal_density: 0", "above 0"}},
    {{"simulate", "deep.json"}, {"deep.json: is nested deeper than 64 levels"}},
    {{"simulate", "/dev/zero"}, {"/dev/zero", "larger than 64 MB"}},
    {{"simulate", "huge.json"}, {"huge.obj: bone 0", "out of range", "100 km"}},
    {{"check", "sheet.pc2", "--scene", "huge.json"}, {"huge.obj: bone 0", "out of range", "100 km"}},
    {{"render", "huge.json", "-o", "a.png"}, {"huge.obj: bone 0", "out of range", "100 km"}},
    {{"simulate", "wide.json"}, {"wide.obj: vertex 0 is at (0, 1e+18, 0) m", "100 km"}},
    {{"render", "infinite.pc2", "--scene", "good.json", "--cloth", "sheet", "-o", "a.png"},
     {"infinite.pc2: frame 2: vertex", "inf", "finite"}},
    {{"simulate", "missing.json"}, {"missing.json: cloths[0].file", "none.obj", "relative to"}},
    {{"simulate", "body.json"}, {"wolk", "walk"}},
    {{"render", "sheet.pc2"}, {"sheet.pc2", "without faces", "--scene"}},
    {{"render", "good.json", "-o", "a.gif"}, {"a.gif", ".png or .mp4"}},
    {{"render", "sheet.pc2", "--scene", "good.json", "-o", "a.png", "--frames", "0:9"},
     {"--frames", "0:9", "frames from 0 to 2"}},
    {{"render", "sheet.pc2", "--scene", "good.json", "-o", "a.png", "--frames", "0:2"},
     {"a.png", "--sheet COLUMNS"}},
    {{"render", "sheet.pc2", "--scene", "good.json", "--cloth", "shet"},
     {"--cloth", "did you mean \"sheet\"?"}},
    {{"check", "sheet.pc2"}, {"--scene is required"}},
    {{"check", "none.pc2", "--scene", "good.json"}, {"none.pc2"}},
    {{"check", "none", "--scene", "good.json"}, {"none: no such folder", "check the path"}},
    {{"check", "cut.pc2", "--scene", "good.json"}, {"cut.pc2"}},
    {{"check", "sheet.pc2", "--scene", "coarse.json"}, {"sheet.pc2", "points", "made from"}},
    {{"check", "sheet.pc2", "sheet.pc2", "--scene", "good.json"},
     {"same cloth \"sheet\"", "one cache of each"}},
    {{"check", "bare", "--scene", "good.json"}, {"bare", "no cache of good.json", "looked for sheet.pc2"}},
    {{"check", ".", "--scene", "good.json", "--cloth", "sheet"}, {"--cloth", "single cache"}},
    {{"info", "none.obj"}, {"none.obj", "can't be found"}},
    {{"info", "text.xyz"}, {"text.xyz", "known are"}},
    {{"info", "mesh.obj", "--json"}, {"mesh.obj", "--json", ".msh or .vtk"}},
    {{"info", "archive.obj"}, {"archive.obj: is no OBJ", "binary"}},
    {{"info", "mesh.obj"}, {"mesh.obj:2", "decimal number"}},
};

/// The same of the program that measures.
const std::vector<BadRun> kBadMeasurements{
    {{"strss"}, {"strss", "did you mean \"stress\"?"}},
    {{"stress", "--only", "nothing"}, {"--only", "nothing", "docs/journal/stress.md"}},
    {{"stress", "-o", "file/there"}, {"file/there", "choose a writable folder"}},
    {{"stress", "--threads", "2"}, {"unknown option --threads"}},
    {{"sheet", "--only", "nothing"}, {"--only", "nothing", "docs/journal/cpu_speed.md"}},
    {{"sheet", "good.json"}, {"good.json", "toile-bench sheet --help"}},
    {{"contact", "--only", "nothing"}, {"--only", "nothing", "docs/journal/contact_stress.md"}},
    {{"contact", "--threads", "0"}, {"--threads", "toile-bench contact --help"}},
    {{"stages", "none.json"}, {"none.json"}},
    {{"stages", "good.json", "--frames", "1"}, {"--frames", "give 2 or more"}},
};

/// Names of the files that appeared, disappeared or changed.
std::string changed_files(const std::map<std::string, std::string>& before,
                          const std::map<std::string, std::string>& after)
{
    std::string names;
    for (const auto& [name, content] : after)
        if (!before.contains(name) || before.at(name) != content)
            names += name + " ";
    for (const auto& [name, content] : before)
        if (!after.contains(name))
            names += name + " ";
    return names;
}

void expect_refused(const char* program, const std::vector<BadRun>& runs)
{
    const TemporaryFolder folder;
    fill(folder);
    const auto before = folder.snapshot();
    for (const BadRun& bad : runs) {
        std::string command = program;
        for (const std::string& argument : bad.arguments)
            command += " " + argument;
        SCOPED_TRACE(command);
        const Finished run = run_program(program, bad.arguments, folder.path());
        EXPECT_EQ(run.exit_code, 2);
        EXPECT_EQ(run.output, "");
        EXPECT_EQ(run.error_lines(), 1) << run.errors;
        EXPECT_EQ(run.errors.find('\n'), run.errors.size() - 1) << run.errors;
        for (const std::string& part : bad.says)
            EXPECT_NE(run.errors.find(part), std::string::npos) << "no \"" << part << "\" in " << run.errors;
        EXPECT_EQ(changed_files(before, folder.snapshot()), "");
    }
}

TEST(BadInput, GivesOneLineAndExitCodeTwoAndChangesNoFile) { expect_refused(TOILE_PROGRAM, kBadRuns); }

TEST(BadInput, IsRefusedByTheBenchmarksInTheSameWay)
{
    expect_refused(TOILE_BENCH_PROGRAM, kBadMeasurements);
}

/// Methods of the literature run in toile-bench alone.
TEST(BadInput, NamesTheProgramThatRunsBaselines)
{
    const TemporaryFolder folder;
    fill(folder);
    const std::vector<std::string> arguments{"simulate", "good.json",  "--solver",
                                             "vbd",      "--no-cache", "--quiet"};
    const Finished refused = run_toile(arguments, folder.path());
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_EQ(refused.error_lines(), 1) << refused.errors;
    EXPECT_NE(refused.errors.find("toile-bench simulate"), std::string::npos) << refused.errors;
    const Finished measured = run_program(TOILE_BENCH_PROGRAM, arguments, folder.path());
    EXPECT_NE(measured.exit_code, 2) << measured.errors;
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "out" / "good" / "sheet.pc2")) << measured.errors;
}

} // namespace
} // namespace toile::test
