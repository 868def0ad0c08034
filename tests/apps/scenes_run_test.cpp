#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "export/point_cache.h"
#include "tests/apps/program.h"

/// Several scenes in one call of simulate: on the CPU, one after the other.
namespace toile::test {

using namespace exports;

namespace {

std::string bytes_in(const TemporaryFolder& folder, const char* file)
{
    return bytes_of(folder.path() / file);
}

TEST(SimulateScenes, WritesTheOutputOfSeparateRuns)
{
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.path() / "more");
    folder.write("a.json", small_scene(3));
    folder.write("more/b.json", small_scene(5));
    const Finished run = run_toile({"simulate", "a.json", "more/b.json", "--report", "runs"}, folder.path());
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_EQ(run.output,
              "out/a/sheet.pc2\nout/a/certificate.json\nout/b/sheet.pc2\nout/b/certificate.json\n");
    for (const char* line : {"a: frame 3/3 (100 %)", "b: frame 5/5 (100 %)", "b: check 5/5 (100 %)",
                             "a: certificate holds for 3 frames", "b: certificate holds for 5 frames"})
        EXPECT_NE(run.errors.find(line), std::string::npos) << line << "\n" << run.errors;
    EXPECT_EQ(nlohmann::json::parse(bytes_in(folder, "runs/a.json"))["settings"]["frames"], 3);
    EXPECT_EQ(nlohmann::json::parse(bytes_in(folder, "runs/b.json"))["settings"]["frames"], 5);

    const Finished alone = run_toile({"simulate", "more/b.json", "-o", "alone", "--quiet"}, folder.path());
    EXPECT_EQ(alone.exit_code, 0) << alone.errors;
    EXPECT_EQ(bytes_in(folder, "out/b/sheet.pc2"), bytes_in(folder, "alone/sheet.pc2"));
}

TEST(SimulateScenes, ContinuesAfterASceneFails)
{
    const TemporaryFolder folder;
    folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    folder.write("a.json", R"({"toile": 1, "frames": 3, "cloths": [{"name": "x", "file": "flat.obj"}]})");
    folder.write("b.json", small_scene(3));
    const Finished run = run_toile({"simulate", "a.json", "b.json", "-o", ".", "--quiet"}, folder.path());
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_EQ(run.output, "./b/sheet.pc2\n./b/certificate.json\n");
    EXPECT_EQ(run.error_lines(), 1) << run.errors;
    EXPECT_EQ(run.errors.rfind("toile: error: a: ", 0), 0u) << run.errors;
    EXPECT_NE(run.errors.find("flat.obj:4: the face has no area"), std::string::npos) << run.errors;
}

TEST(SimulateScenes, StartsNoSceneAfterAnInterrupt)
{
    const TemporaryFolder folder;
    folder.write("a.json", small_scene(1000000));
    folder.write("b.json", small_scene(3));
    const std::filesystem::path partial = folder.path() / "out/a/sheet.partial.pc2";
    const Finished run = run_and_interrupt({"simulate", "a.json", "b.json"}, folder.path(), partial);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_EQ(run.output, "out/a/sheet.partial.pc2\n");
    EXPECT_EQ(run.error_lines(), 2) << run.errors;
    EXPECT_NE(run.errors.find("toile: error: a: interrupted at frame"), std::string::npos) << run.errors;
    EXPECT_NE(run.errors.find("toile: error: b: interrupted before it was begun"), std::string::npos)
        << run.errors;
    EXPECT_GE(read_cache(partial).frame_count(), 1);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out/b"));
}

} // namespace
} // namespace toile::test
