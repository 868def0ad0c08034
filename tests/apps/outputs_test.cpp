#include <gtest/gtest.h>

#include "tests/apps/program.h"

/// Outputs that are inputs, and two outputs that are one file: refused before anything is touched.
namespace toile::test {

namespace {

using std::filesystem::path;

std::string exports_scene(const std::string& exports, int frames = 3)
{
    std::string scene = R"({"toile": 1, "frames": )";
    scene += std::to_string(frames);
    scene += R"(, "export": [)" + exports;
    scene += R"(], "cloths": [{"name": "c", "rectangle": {"size": [0.2, 0.2], "resolution": 0.1}},
                              {"name": "d", "disc": {"radius": 0.1, "resolution": 0.1},
                               "translate": [1, 0, 0]}]})";
    return scene;
}

/// A scene whose cloth, avatar and solid are files, with a finished run of it in out/.
class Outputs : public FileTest {
protected:
    Outputs()
    {
        const std::string square = "v 0 0 0\nv 0 0 0.2\nv 0.2 0 0.2\nv 0.2 0 0\nf 1 2 3 4\n";
        for (const char* mesh : {"sheet.obj", "sheet_0002.obj", "sheet_0007.obj"})
            temporary_.write(mesh, square);
        temporary_.write("body.obj", "v 0 -1 0\nv 0 -1 9\nv 9 -1 9\nf 1 2 3\n");
        temporary_.write("s.json", scene("sheet.obj"));
        temporary_.write("flat.obj", "v 0 0 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
        temporary_.write("rest.json", R"({"toile": 1, "frames": 1, "cloths": [{"name": "q",
            "file": "sheet.obj", "rest": "uv", "rest_file": "flat.obj"}]})");
        temporary_.write("certificate.json", R"({"toile": 1, "frames": 1, "cloths": [{"name": "q",
            "rectangle": {"size": [0.2, 0.2], "resolution": 0.1}}]})");
        temporary_.write("sequence.json", scene("sheet_0002.obj", R"("export": [{"file": "sheet.obj"}])"));
        temporary_.write("surplus.json", scene("sheet_0007.obj", R"("export": [{"file": "sheet.obj"}])"));
        temporary_.write("body.json", scene("sheet.obj", R"("export": [{"file": "body.obj"}])", 1));
        temporary_.write("gltf.json", R"({"toile": 1, "frames": 1,
            "cloths": [{"name": "q", "rectangle": {"size": [0.2, 0.2], "resolution": 0.1}}],
            "avatars": [{"name": "b", "file": "b.gltf"}]})");
        const path column = path(TOILE_SOURCE_DIR) / "tests/avatars/bending_column.gltf";
        temporary_.write("b.gltf", R"({"images": [{"uri": "my%20skin.png"}], )" + bytes_of(column).substr(1));
        temporary_.write("c.gltf",
                         R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4, "uri": "c.bin"}]})");
        temporary_.write("c.json", R"({"toile": 1, "frames": 1, "cloths": [{"name": "q", "disc": {}}],
                                       "avatars": [{"name": "b", "file": "c.gltf"}]})");
        temporary_.write("c.bin", "abcd");
        temporary_.write("my skin.png", "png");
        temporary_.write("meshes.json", exports_scene(R"({"file": "c.pc2", "cloth": "c"},
                                                        {"file": "c.mdd", "cloth": "d"})"));
        temporary_.write("sequences.json", exports_scene(R"({"file": "s.obj", "cloth": "c"},
                                                           {"file": "s_####.obj", "cloth": "d"})"));
        temporary_.write("sequence_and_mesh.json", exports_scene(R"({"file": "c.obj", "cloth": "c"},
                                                                   {"file": "c.pc2", "cloth": "d"})"));
        temporary_.write("mesh_and_obj.json", exports_scene(R"({"file": "c.pc2", "cloth": "c"},
                                                              {"file": "c.obj", "cloth": "d"})",
                                                            1));
        temporary_.write("partial.json", exports_scene(R"({"file": "c.pc2", "cloth": "c"},
                                                         {"file": "c.partial.pc2", "cloth": "d"})"));
        temporary_.write("linked.json", exports_scene(R"({"file": "a/c.pc2", "cloth": "c"},
                                                        {"file": "b/c.pc2", "cloth": "d"})"));
        std::filesystem::create_directories(file("linked/a"));
        std::filesystem::create_directory_symlink("a", file("linked/b"));
        std::filesystem::create_symlink("s.json", file("link.json"));
        std::filesystem::create_hard_link(file("s.json"), file("twin.json"));
        std::filesystem::create_symlink("loop", file("loop"));
        std::filesystem::create_symlink("nowhere", file("dangling"));
        std::filesystem::create_directories(file("taken/mesh/sheet.partial.obj"));
        std::filesystem::create_directories(file("taken/certificate/certificate.json"));
        std::filesystem::create_directories(file("taken/cache/sheet.pc2"));
        std::filesystem::create_directories(file("taken/frame/c_0001.obj"));
        std::filesystem::create_directories(file("taken/pictures/frame_0002.png"));
    }

    static std::string scene(const std::string& mesh, const std::string& keys = R"("description": "")",
                             int frames = 3)
    {
        std::string scene = R"({"toile": 1, "frames": )";
        scene += std::to_string(frames);
        scene += R"(, "cloths": [{"name": "sheet", "file": ")" + mesh;
        scene += R"("}], "avatars": [{"name": "body", "file": "body.obj"}], )" + keys + "}";
        return scene;
    }
};

struct Refused {
    std::vector<std::string> arguments;
    std::vector<std::string> says;
};

const std::vector<Refused> kRefused{
    // Inputs.
    {{"simulate", "s.json", "-o", "."}, {"./sheet.obj", "start mesh of \"sheet\"", "file of cloth"}},
    {{"simulate", "s.json", "-o", "out/.."}, {"start mesh of \"sheet\"", "file of cloth"}},
    {{"simulate", "body.json", "-o", "."}, {"body.obj", "cache of \"sheet\"", "file of avatar \"body\""}},
    {{"simulate", "sequence.json", "-o", "."}, {"sheet_0002.obj", "file of cloth"}},
    {{"simulate", "surplus.json", "-o", "."}, {"sheet_0007.obj", "file of cloth"}},
    {{"simulate", "certificate.json", "-o", "."}, {"the certificate would replace", "the scene"}},
    {{"simulate", "certificate.json", "-o", ".", "--no-check"}, {"the certificate would replace"}},
    {{"simulate", "s.json", "--report", "s.json"}, {"the report would replace s.json, the scene"}},
    {{"simulate", "s.json", "--report", "link.json"}, {"link.json", "s.json, the scene"}},
    {{"simulate", "s.json", "--report", "twin.json"}, {"twin.json", "s.json, the scene"}},
    {{"simulate", "link.json", "--report", "out/../s.json"}, {"out/../s.json", "link.json, the scene"}},
    {{"simulate", "s.json", "--report", "sheet.obj"}, {"the report would replace", "file of cloth"}},
    {{"simulate", "rest.json", "--report", "flat.obj"}, {"flat.obj", "the rest file of cloth \"q\""}},
    {{"simulate", "c.json", "--report", "c.bin"}, {"c.bin", "a part of", "c.gltf"}},
    {{"simulate", "gltf.json", "--report", "my skin.png"}, {"my skin.png", "a part of"}},
    {{"simulate", "s.json", "sequences.json", "--report", "."}, {"./s.json", "the scene"}},
    {{"check", "out", "--scene", "s.json", "-o", "out/sheet.pc2"}, {"a cache to check"}},
    {{"check", "out", "--scene", "s.json", "-o", "twin.json"}, {"twin.json", "the scene"}},
    {{"check", "out/sheet.pc2", "--scene", "s.json", "-o", "body.obj"}, {"file of avatar"}},
    {{"render", "gltf.json", "-o", "my skin.png"}, {"my skin.png", "a part of", "b.gltf"}},
    // Outputs.
    {{"simulate", "meshes.json"}, {"c.obj", "start mesh of \"c\"", "start mesh of \"d\""}},
    {{"simulate", "mesh_and_obj.json"}, {"c.obj", "cache of \"d\"", "start mesh of \"c\""}},
    {{"simulate", "sequences.json"}, {"s_0000.obj", "cache of \"c\"", "cache of \"d\""}},
    {{"simulate", "partial.json"}, {"c.partial.pc2", "unfinished"}},
    {{"simulate", "linked.json", "-o", "linked"}, {"linked/b/c.pc2", "linked/a/c.pc2"}},
    {{"simulate", "s.json", "-o", "out", "--report", "out/certificate.json"}, {"certificate", "report"}},
    {{"simulate", "s.json", "-o", "out", "--report", "out/sheet.pc2"}, {"cache of", "report"}},
    {{"simulate", "s.json", "-o", "out", "--report", "out/sheet.partial.pc2"}, {"cache of", "report"}},
    {{"simulate", "s.json", "-o", "out", "--report", "out/sheet.obj"}, {"start mesh", "report"}},
    {{"simulate", "s.json", "-o", "new", "--report", "new"}, {"report is in the way of", "new"}},
    {{"simulate", "s.json", "-o", "new", "--report", "new/sheet.pc2/r"}, {"report is in the way of"}},
    {{"simulate", "s.json", "-o", "new", "--report", "new/.toile.lock"}, {"the lock", "report"}},
    // What can't be written.
    {{"simulate", "s.json", "-o", "loop/x"}, {"loop", "Too many levels of symbolic links"}},
    {{"simulate", "s.json", "-o", "dangling"}, {"dangling", "can't be created"}},
    {{"simulate", "s.json", "-o", "taken/mesh"}, {"sheet.partial.obj", "is a folder"}},
    {{"simulate", "s.json", "-o", "taken/certificate"}, {"certificate.json", "is no regular file"}},
    {{"simulate", "s.json", "-o", "taken/cache"}, {"sheet.pc2", "is no regular file"}},
    {{"simulate", "sequence_and_mesh.json", "-o", "taken/frame"}, {"c_0001.obj", "is no regular file"}},
    {{"simulate", "sequence_and_mesh.json", "-o", "x", "--report", "x/c.partial"}, {"c.partial", "way of"}},
    {{"render", "out/sheet.pc2", "--scene", "s.json", "-o", "taken/pictures"},
     {"frame_0002.png", "is a folder"}},
    {{"simulate", "s.json", "--report", "/proc/run.json"}, {"/proc/run.json", "can't be written"}},
    {{"simulate", "s.json", "-o", "/proc/out"}, {"/proc/out", "can't be written"}},
    {{"simulate", "s.json", "--report", "new/"}, {"new/", "is a folder"}},
    {{"simulate", "s.json", "--report", std::string(300, 'r')}, {"File name too long"}},
    {{"check", "out", "--scene", "s.json", "-o", "/proc/c.json"}, {"can't be written"}},
    {{"render", "s.json", "-o", "/proc/a.png"}, {"can't be written"}},
    {{"render", "s.json", "-o", "/proc/pictures"}, {"can't be written"}},
};

TEST_F(Outputs, ThatAreInputsOrOneFileAreRefusedBeforeAnythingIsTouched)
{
    ASSERT_EQ(run_toile({"simulate", "s.json", "-o", "out", "--quiet"}, folder_).exit_code, 0);
    // The salvageable cache of a killed run.
    std::filesystem::copy(file("out/sheet.pc2"), file("out/sheet.partial.pc2"));
    const auto before = temporary_.snapshot();
    for (const Refused& refused : kRefused) {
        std::string command;
        for (const std::string& argument : refused.arguments)
            command += argument + " ";
        SCOPED_TRACE(command);
        const Finished run = run_toile(refused.arguments, folder_);
        EXPECT_EQ(run.exit_code, 2);
        EXPECT_EQ(run.output, "");
        EXPECT_EQ(run.error_lines(), 1) << run.errors;
        for (const std::string& part : refused.says)
            EXPECT_NE(run.errors.find(part), std::string::npos) << "no " << part << " in " << run.errors;
        EXPECT_EQ(temporary_.snapshot(), before);
    }
    RecordProperty("refused", int(kRefused.size()));
}

TEST_F(Outputs, OfSpecialFilesAreNotReplaced)
{
    const Finished run = run_shell(
        "mkfifo pipe; cat pipe > seen & \"$TOILE\" simulate s.json -o p --quiet --report pipe; code=$?;"
        "wait; \"$TOILE\" simulate s.json -o q --quiet --report /dev/stdout && exit $code",
        folder_);
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_EQ(std::filesystem::status(file("pipe")).type(), std::filesystem::file_type::fifo);
    EXPECT_NE(bytes_of(file("seen")).find("\"outcome\": \"complete\""), std::string::npos);
    EXPECT_EQ(run.output.rfind("p/sheet.pc2\np/certificate.json\nq/sheet.pc2\n{\n", 0), 0u) << run.output;
}

TEST_F(Outputs, ReplaceALinkAndKeepWhatItPointsTo)
{
    temporary_.write("other.pc2", "precious");
    std::filesystem::create_directory(file("out"));
    std::filesystem::create_symlink("../other.pc2", file("out/sheet.pc2"));
    EXPECT_EQ(run_toile({"simulate", "s.json", "-o", "out", "--quiet"}, folder_).exit_code, 0);
    EXPECT_EQ(bytes_of(file("other.pc2")), "precious");
    EXPECT_FALSE(std::filesystem::is_symlink(file("out/sheet.pc2")));
}

/// The frames of c.obj are c_0000.obj and so on; c.obj itself is the start mesh of the other cloth.
TEST_F(Outputs, ASequenceLeavesItsBareNameFree)
{
    const Finished run = run_toile({"simulate", "sequence_and_mesh.json", "-o", "q", "--quiet"}, folder_);
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    const Finished check = run_toile({"check", "q", "--scene", "sequence_and_mesh.json", "--quiet"}, folder_);
    EXPECT_EQ(check.exit_code, 0) << check.errors;
}

TEST_F(Outputs, OfTwoRunsDoNotMeet)
{
    temporary_.write("long.json", small_scene(1000000));
    Running first({"simulate", "long.json", "-o", "out", "--quiet"}, folder_);
    Running::wait_for_file(file("out/sheet.partial.pc2"));
    const std::string name = "process " + std::to_string(first.process());
    for (const std::vector<std::string>& second : std::vector<std::vector<std::string>>{
             {"simulate", "s.json", "-o", "out"}, {"simulate", "long.json", "-o", "out/../out"}}) {
        const Finished run = run_toile(second, folder_);
        EXPECT_EQ(run.exit_code, 2);
        EXPECT_EQ(run.error_lines(), 1) << run.errors;
        EXPECT_NE(run.errors.find("another run is writing there, " + name), std::string::npos) << run.errors;
    }
    first.end(SIGKILL);
    EXPECT_EQ(run_toile({"simulate", "s.json", "-o", "out", "--quiet"}, folder_).exit_code, 0);
    EXPECT_FALSE(std::filesystem::exists(file("out/.toile.lock")));
}

} // namespace
} // namespace toile::test
