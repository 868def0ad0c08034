#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdlib>
#include <filesystem>

#include "core/base/error.h"
#include "core/mesh/obj.h"
#include "core/mesh/topology.h"
#include "scenes/format/read_scene.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

using namespace scenes;

namespace {

const std::filesystem::path kSource = TOILE_SOURCE_DIR;

std::string complaint_about(const std::string& file_entry)
{
    try {
        static_cast<void>(parse_scene(R"({"toile": 1, "frames": 1, "cloths": [{"name": "a", "file": ")" +
                                          file_entry + R"("}]})",
                                      kSource / "scenes/demo/test.json"));
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "accepted";
}

/// Sets an environment variable for the length of a test.
class ScopedVariable {
public:
    ScopedVariable(const char* name, const std::string& value) : name_(name)
    {
        if (const char* before = std::getenv(name))
            before_ = before;
        ::setenv(name, value.c_str(), 1);
    }
    ~ScopedVariable() { before_ ? ::setenv(name_, before_->c_str(), 1) : ::unsetenv(name_); }
    ScopedVariable(const ScopedVariable&) = delete;
    ScopedVariable& operator=(const ScopedVariable&) = delete;

private:
    const char* name_;
    std::optional<std::string> before_;
};

TEST(SceneFiles, FindsPathsRelativeToTheSceneAndInTheDataFolder)
{
    EXPECT_EQ(complaint_about("../../assets/round_table.obj"), "accepted");

    const ScopedVariable data("TOILE_DATA_DIR", (kSource / "assets").string());
    EXPECT_EQ(complaint_about("${TOILE_DATA_DIR}/round_table.obj"), "accepted");
}

TEST(SceneFiles, FollowsLinksBeforeDotDot)
{
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder.path() / "far/deep");
    std::filesystem::create_directory_symlink("far/deep", folder.path() / "door");
    folder.write("far/m.obj", "far");
    folder.write("m.obj", "near");
    std::filesystem::create_directory(folder.path() / "d.obj");
    const auto file_of = [&](const std::string& file) {
        const Scene scene =
            parse_scene(R"({"toile": 1, "frames": 1, "cloths": [{"name": "a", "file": ")" + file + R"("}]})",
                        folder.path() / "s.json");
        return bytes_of(std::get<std::filesystem::path>(scene.cloths[0].shape));
    };
    EXPECT_EQ(file_of("door/../m.obj"), "far");
    EXPECT_EQ(file_of("far/../m.obj"), "near");
    EXPECT_NE(refusal([&] { file_of("d.obj"); }).find("is a folder, pipe or device"), std::string::npos);
}

TEST(SceneFiles, NamesTheMissingFileOrFolder)
{
    const std::string scene = (kSource / "scenes/demo/test.json").string();
    EXPECT_EQ(complaint_about("../../assets/square_table.obj"),
              scene + ": cloths[0].file: the file \"" + (kSource / "assets/square_table.obj").string() +
                  "\" does not exist; paths are relative to the folder of the file that names them");
    EXPECT_EQ(
        complaint_about("${HOME}/a.obj"),
        scene +
            ": cloths[0].file: \"${HOME}/a.obj\" names an unknown variable; only ${TOILE_DATA_DIR} is known");

    const ScopedVariable data("TOILE_DATA_DIR", "/no/such/folder");
    EXPECT_EQ(complaint_about("${TOILE_DATA_DIR}/a.obj"),
              scene +
                  ": cloths[0].file: the data folder \"/no/such/folder\" does not exist; set the environment "
                  "variable TOILE_DATA_DIR");
}

TEST(SceneFiles, RefusesASceneThatIsMissingOrAFolder)
{
    EXPECT_THROW(static_cast<void>(read_scene(kSource / "scenes/demo/none.json")), InvalidInput);
    EXPECT_THROW(static_cast<void>(read_scene(kSource)), InvalidInput);
}

/// Reads every scene of a folder; returns their number.
int read_all(const std::filesystem::path& folder)
{
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".json")
            continue;
        EXPECT_NO_THROW(static_cast<void>(read_scene(entry.path())));
        ++count;
    }
    return count;
}

TEST(SceneFiles, ReadsTheDemoScenes)
{
    EXPECT_EQ(read_all(kSource / "scenes/demo"), 2);
    EXPECT_EQ(read_all(kSource / "scenes/contact"), 7);
    EXPECT_EQ(read_all(kSource / "scenes/details"), 4);
    EXPECT_EQ(read_all(kSource / "scenes/benchmarks"), 3);
}

TEST(SceneFiles, ReadsTheScenesOfRealData)
{
    if (!std::filesystem::is_directory(TOILE_DATA_DIR))
        GTEST_SKIP() << "SKIPPED: TOILE_DATA_DIR has no data";
    EXPECT_EQ(read_all(kSource / "scenes/data"), 10);
    EXPECT_EQ(read_all(kSource / "scenes/dressed"), 17);
}

TEST(SceneFiles, TheRoundTableIsClosedAndStandsOnTheFloor)
{
    const TriangleMesh table = read_obj(kSource / "assets/round_table.obj").triangulated();
    require_usable(table, "round_table.obj");
    EXPECT_TRUE(build_topology(table.triangles, table.vertex_count(), "round_table.obj").is_closed());
    EXPECT_EQ(bounds(table.positions).lower.y(), 0.0);
    double volume = 0.0; // by the divergence theorem; positive if triangles face outwards
    for (const Triangle& t : table.triangles)
        volume += table.positions[t[0]].dot(table.positions[t[1]].cross(table.positions[t[2]])) / 6.0;
    EXPECT_GT(volume, 0.02);
}

} // namespace
} // namespace toile::test
