#include <csignal>

#include <gtest/gtest.h>

#include "export/point_cache.h"
#include "tests/apps/program.h"

/// What can't be delivered is said in one line, and what can is kept.
namespace toile::test {

using namespace exports;

namespace {

class Undelivered : public FileTest {
protected:
    Undelivered() { temporary_.write("drop.json", small_scene(4)); }

    /// Runs a script that ends with the exit code of toile.
    Finished shell(const std::string& script) const { return run_shell(script, folder_); }

    void expect_failure(const Finished& run, const std::string& says) const
    {
        EXPECT_EQ(run.exit_code, 1) << run.errors;
        EXPECT_EQ(run.error_lines(), 1) << run.errors;
        EXPECT_NE(run.errors.find(says), std::string::npos) << run.errors;
    }

    void expect_whole_cache(const std::string& name = "out/sheet.pc2") const
    {
        EXPECT_EQ(read_cache(file(name)).frame_count(), 4);
    }
};

TEST_F(Undelivered, ReportLeavesCachesAndCertificate)
{
    expect_failure(shell("\"$TOILE\" simulate drop.json -o out --quiet --report /dev/full"),
                   "/dev/full: writing broke off (No space left on device)");
    expect_whole_cache();
    EXPECT_TRUE(std::filesystem::exists(file("out/certificate.json")));
}

/// Single precision is too coarse for its shapes 90 km away.
TEST_F(Undelivered, CacheForOtherProgramsLeavesTheRest)
{
    temporary_.write("far.obj", "v 90000 0 0\nv 90001 0 0\nv 90000 0 1\nf 1 3 2\n");
    temporary_.write("far.json", R"({"toile": 1, "frames": 12, "wind": {"velocity": [20, 0, 5]},
        "cloths": [{"name": "sheet", "file": "far.obj"}],
        "export": [{"file": "sheet.glb"}, {"file": "sheet.pc2"}]})");
    expect_failure(shell("\"$TOILE\" simulate far.json -o out --quiet"),
                   "out/sheet.glb: single precision holds its positions within ");
    EXPECT_EQ(read_cache(file("out/sheet.pc2")).frame_count(), 12);
    EXPECT_TRUE(std::filesystem::exists(file("out/certificate.json")));
    EXPECT_FALSE(std::filesystem::exists(file("out/sheet.glb")));
    EXPECT_EQ(read_cache(file("out/sheet.glb.partial.pc2")).frame_count(), 12);
}

TEST_F(Undelivered, CertificateLeavesCaches)
{
    // The partial name of the certificate is taken by a folder.
    std::filesystem::create_directories(file("out/certificate.partial.json/full"));
    expect_failure(shell("\"$TOILE\" simulate drop.json -o out --quiet --report run.json"),
                   "out/certificate.json: can't be written");
    expect_whole_cache();
    EXPECT_TRUE(std::filesystem::exists(file("run.json")));
    EXPECT_FALSE(std::filesystem::exists(file("out/certificate.json")));
}

TEST_F(Undelivered, ClosedStreamsNeverBecomeACache)
{
    for (const char* closed : {"<&-", ">&-", "2>&-", "<&- >&-", "<&- >&- 2>&-"}) {
        SCOPED_TRACE(closed);
        const Finished run = shell(std::string("\"$TOILE\" simulate drop.json -o out ") + closed);
        EXPECT_EQ(run.exit_code, 0) << run.errors;
        expect_whole_cache();
        EXPECT_EQ(bytes_of(file("out/sheet.pc2")).rfind("POINTCACHE2", 0), 0u);
        std::filesystem::remove_all(file("out"));
    }
}

TEST_F(Undelivered, StandardOutputIsAFailureOfEveryCommand)
{
    const std::string says = "standard output can't be written";
    expect_failure(shell("\"$TOILE\" simulate drop.json -o out --quiet > /dev/full"), says);
    expect_whole_cache();
    for (const char* command : {"info out/sheet.pc2", "check out --scene drop.json --quiet", "schema",
                                "render drop.json -o a.png --quiet", "--help", "--version"}) {
        SCOPED_TRACE(command);
        expect_failure(shell(std::string("\"$TOILE\" ") + command + " > /dev/full"), says);
    }
    // A reader that has ended: the file descriptor of a pipe whose reader is gone.
    expect_failure(shell("mkfifo p; (exec 3< p) & exec 4> p; wait; \"$TOILE\" info out/sheet.pc2 >&4"), says);
    expect_failure(shell("(exec 3< p) & exec 4> p; wait; \"$TOILE\" simulate drop.json -o new --quiet >&4"),
                   says);
    expect_whole_cache("new/sheet.pc2");
}

TEST_F(Undelivered, FilesBeyondALimitOfTheirSize)
{
    temporary_.write("long.json", small_scene(60));
    const Finished run = shell("ulimit -f 16; \"$TOILE\" simulate long.json -o out --quiet");
    expect_failure(run, "failed at frame ");
    EXPECT_NE(run.errors.find("sheet.partial.pc2: writing broke off (File too large)"), std::string::npos);
    EXPECT_GE(read_cache(file("out/sheet.partial.pc2")).frame_count(), 1);
    EXPECT_FALSE(std::filesystem::exists(file("out/sheet.pc2")));
}

/// Some limits are enough, some are not; none may hang, abort or leave a damaged cache.
TEST_F(Undelivered, MemoryBeyondALimit)
{
    temporary_.write("fine.json", R"({"toile": 1, "frames": 4, "cloths": [{"name": "sheet",
        "rectangle": {"size": [0.6, 0.6], "resolution": 0.01}}]})");
    int failed = 0;
    for (const int mebibytes : {140, 170, 200}) {
        const std::string limit = "ulimit -v " + std::to_string(1024 * mebibytes) + "; \"$TOILE\" ";
        if (shell(limit + "--version").exit_code != 0)
            continue; // too little for its libraries on this machine
        for (const char* command : {"simulate fine.json -o out --quiet --no-cache --no-check",
                                    "render drop.json -o a.png --quiet"}) {
            SCOPED_TRACE(limit + command);
            std::filesystem::remove_all(file("out"));
            const Finished run = shell(limit + command);
            if (run.exit_code == 0)
                continue;
            ++failed;
            expect_failure(run, "out of memory");
            if (std::filesystem::exists(file("out/sheet.partial.pc2"))) {
                EXPECT_GE(read_cache(file("out/sheet.partial.pc2")).frame_count(), 1);
            }
        }
    }
    RecordProperty("out_of_memory", failed);
}

TEST_F(Undelivered, FolderThatIsRemovedWhileTheRunWrites)
{
    temporary_.write("drop.json", small_scene(1000000));
    Running run({"simulate", "drop.json", "-o", "out", "--quiet"}, folder_);
    Running::wait_for_file(file("out/sheet.partial.pc2"));
    std::filesystem::remove_all(file("out"));
    expect_failure(run.end(0), "was removed or replaced while it was being written");
}

TEST_F(Undelivered, SceneThatIsRemovedWhileTheRunWrites)
{
    temporary_.write("drop.json", small_scene(100, R"("solver": {"sleep": {"enabled": false}})"));
    Running run({"simulate", "drop.json", "-o", "out", "--quiet"}, folder_);
    Running::wait_for_file(file("out/sheet.partial.pc2"));
    std::filesystem::remove(file("drop.json"));
    const Finished end = run.end(0);
    EXPECT_EQ(end.exit_code, 0) << end.errors;
    EXPECT_EQ(read_cache(file("out/sheet.pc2")).frame_count(), 100);
}

} // namespace
} // namespace toile::test
