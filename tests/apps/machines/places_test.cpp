#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "export/point_cache.h"
#include "tests/apps/program.h"

/// Names, folders, users and environments as other machines have them.
namespace toile::test {

using namespace exports;

namespace {

class Places : public FileTest {
protected:
    Places() { temporary_.write("s.json", small_scene(3)); }

    void expect_run(const std::string& script) const
    {
        SCOPED_TRACE(script);
        const Finished run = run_shell(script, folder_);
        EXPECT_EQ(run.exit_code, 0) << run.errors;
        EXPECT_EQ(run.error_lines(), 0) << run.errors;
    }
};

/// Spaces, line breaks, quotes, UTF-8, and bytes that are no UTF-8.
TEST_F(Places, NamesMayHaveAnyBytes)
{
    int names = 0;
    for (const std::string name :
         {"a b", "a\nb", "\"q'", "\xc3\xa4\xe2\x82\xac", "bad\xff", "%s%n", "-", "#*?"}) {
        SCOPED_TRACE(++names);
        const std::filesystem::path in = file(name + " in");
        std::filesystem::create_directory(in);
        std::filesystem::copy(file("s.json"), in / (name + ".json"));
        const std::string scene = in / (name + ".json"), out = file(name + " out");
        const Finished run =
            run_toile({"simulate", scene, "-o", out, "--report", out + "/r.json", "--quiet"}, folder_);
        EXPECT_EQ(run.exit_code, 0) << run.errors;
        EXPECT_EQ(run.errors, "");
        EXPECT_EQ(read_cache(out + "/sheet.pc2").frame_count(), 3);
        for (const char* written : {"/r.json", "/certificate.json"})
            EXPECT_TRUE(nlohmann::json::accept(bytes_of(out + written))) << written;
        EXPECT_EQ(run_toile({"check", out, "--scene", scene, "--quiet"}, folder_).exit_code, 0);
        EXPECT_EQ(run_toile({"render", scene, "-o", out + "/p.png", "--quiet"}, folder_).exit_code, 0);
    }
}

TEST_F(Places, EnvironmentsMayBeEmptyOrWrong)
{
    const std::string command = " \"$TOILE\" simulate s.json -o out --solver quadrature --quiet";
    for (const std::string with :
         {"env -i", "env -u HOME", "HOME=", "HOME=/dev/null", "HOME=/dev/null XDG_CACHE_HOME=relative",
          "TMPDIR=/dev/null", "COLUMNS=1 LINES=0", "COLUMNS=x TERM=none", "LC_ALL=de_DE.UTF-8 LANG=tr_TR",
          "TOILE_DATA_DIR=/dev/null"})
        expect_run(with + command);
    expect_run("umask 077; " + command);
    EXPECT_EQ(std::filesystem::status(file("out/sheet.pc2")).permissions(),
              std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
}

TEST_F(Places, FoldersThatCannotBeWrittenAreRefusedBeforeTheRun)
{
    const std::string nobody = "setpriv --reuid=65534 --regid=65534 --clear-groups ";
    if (run_shell(nobody + "\"$TOILE\" --version", folder_).exit_code != 0)
        GTEST_SKIP() << "only the superuser can run this as another user, of a program that all can read";
    const auto expect_refused = [&](const std::string& script, const std::string& says) {
        SCOPED_TRACE(script);
        const auto before = temporary_.snapshot();
        const Finished run = run_shell(script, folder_);
        EXPECT_EQ(run.exit_code, 2) << run.errors;
        EXPECT_EQ(run.error_lines(), 1) << run.errors;
        EXPECT_NE(run.errors.find(says), std::string::npos) << run.errors;
        EXPECT_EQ(temporary_.snapshot(), before);
    };
    std::filesystem::permissions(folder_, std::filesystem::perms(0755));
    const std::string simulate = nobody + "\"$TOILE\" simulate s.json --no-cache --quiet";
    expect_refused(simulate, "out/s: can't be written (Permission denied)");
    expect_refused(nobody + "\"$TOILE\" render s.json --quiet",
                   "s.png: can't be written (Permission denied)");
    ASSERT_EQ(run_shell("mkdir shut free; chmod 700 shut; chmod 777 free", folder_).exit_code, 0);
    expect_refused(simulate + " -o shut/out", "Permission denied");
    // A folder like /tmp: all may write, but files of others stay.
    ASSERT_EQ(
        run_shell("mkdir sticky; chmod 1777 sticky; \"$TOILE\" simulate s.json -o sticky --quiet", folder_)
            .exit_code,
        0);
    expect_refused(simulate + " -o sticky", "sticky/sheet.pc2: is of another user, who alone can replace it");
    expect_refused(simulate + " -o free --report sticky/certificate.json",
                   "sticky/certificate.json: is of another user");
}

/// Every size of a disk on which the run does not fit leaves the earlier run and a partial that can be read.
TEST_F(Places, DisksMayBeFull)
{
    temporary_.write("long.json", small_scene(100));
    const std::string on_disk = "unshare -rm sh -c 'mkdir -p disk; mount -t tmpfs -o size=";
    if (run_shell(on_disk + "64k tmpfs disk'", folder_).exit_code != 0)
        GTEST_SKIP() << "no disk of a chosen size can be mounted here";
    int full = 0;
    for (const int kibibytes : {16, 20, 24, 32, 48, 64, 96, 128, 400}) {
        const Finished run = run_shell(on_disk + std::to_string(kibibytes) + R"(k tmpfs disk || exit 99
            "$0" simulate s.json -o disk --quiet > earlier || exit 98
            cp disk/* . && "$0" simulate long.json -o disk --quiet
            code=$?
            [ $code = 0 ] || cmp disk/sheet.pc2 sheet.pc2 || exit 97
            [ $code = 0 ] || cmp disk/certificate.json certificate.json || exit 96
            [ ! -e disk/sheet.partial.pc2 ] || "$0" info disk/sheet.partial.pc2 | grep frames || exit 95
            exit $code' "$TOILE")",
                                       folder_);
        SCOPED_TRACE(kibibytes);
        EXPECT_TRUE(run.exit_code == 0 || run.exit_code == 1) << run.exit_code << run.errors;
        if (run.exit_code == 0)
            continue;
        ++full;
        EXPECT_EQ(run.error_lines(), 1) << run.errors;
        EXPECT_NE(run.errors.find("No space left on device"), std::string::npos) << run.errors;
    }
    EXPECT_GE(full, 5);
    RecordProperty("full_disks", full);
}

} // namespace
} // namespace toile::test
