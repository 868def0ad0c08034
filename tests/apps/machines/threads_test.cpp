#include <gtest/gtest.h>

#include "tests/apps/program.h"

/// Any number of threads, on any number of cores.
namespace toile::test {

namespace {

/// A sheet that folds over a ball, on another one that falls along.
const char* const kFolding = R"({"toile": 1, "frames": 12, "solver": {"method": "direct"},
    "avatars": [{"name": "ball", "sphere": {"radius": 0.1}}],
    "cloths": [
        {"name": "lower", "rectangle": {"size": [0.5, 0.5], "resolution": 0.02}, "translate": [0, 0.103, 0]},
        {"name": "upper", "disc": {"radius": 0.2, "resolution": 0.02}, "translate": [0, 0.106, 0]}]})";

class Threads : public FileTest {
protected:
    Threads() { temporary_.write("s.json", kFolding); }

    std::string caches(const std::string& name) const
    {
        return bytes_of(file(name + "/lower.pc2")) + bytes_of(file(name + "/upper.pc2"));
    }
};

TEST_F(Threads, GiveTheSameBitsInAnyNumber)
{
    std::string expected;
    for (const std::string count : {"1", "2", "3", "7", "64", "0"}) {
        const Finished run =
            run_toile({"simulate", "s.json", "-o", count, "--threads", count, "--no-check"}, folder_);
        EXPECT_EQ(run.exit_code, 0) << run.errors;
        expected = expected.empty() ? caches(count) : expected;
        EXPECT_GT(expected.size(), 10000u);
        EXPECT_TRUE(caches(count) == expected) << count;
    }
    if (run_shell("taskset -c 0 true", folder_).exit_code != 0)
        GTEST_SKIP() << "SKIPPED on one core: this machine does not pin programs to core 0";
    const Finished pinned =
        run_shell("exec taskset -c 0 \"$TOILE\" simulate s.json -o pinned --no-check", folder_);
    EXPECT_EQ(pinned.exit_code, 0) << pinned.errors;
    EXPECT_TRUE(caches("pinned") == expected) << "on one core";
}

TEST_F(Threads, AreRefusedBeyondTheirRange)
{
    for (const std::string count : {"-1", "1025", "10000", "99999999999999999999", "two", "1.5", ""}) {
        const Finished run = run_toile({"simulate", "s.json", "-o", "out", "--threads=" + count}, folder_);
        EXPECT_EQ(run.exit_code, 2) << count;
        EXPECT_EQ(run.error_lines(), 1) << run.errors;
        EXPECT_NE(run.errors.find("--threads"), std::string::npos) << run.errors;
        EXPECT_FALSE(std::filesystem::exists(file("out")));
    }
}

} // namespace
} // namespace toile::test
