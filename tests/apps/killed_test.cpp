#include <chrono>
#include <csignal>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include "apps/toile/terminal/interrupt.h"
#include "export/cache_writer.h"
#include "export/point_cache.h"
#include "tests/apps/kill_points.h"
#include "tests/apps/program.h"

/// Runs that are killed while an earlier one lies in their folder.
namespace toile::test {

using namespace exports;
using std::filesystem::path;

namespace {

/// Files of a finished run by name.
using Files = std::map<std::string, std::string>;

const std::vector<std::string> kDelivered{"sheet.pc2", "sheet.obj", "certificate.json", "run.json"};

class Killed : public FileTest {
protected:
    Killed()
    {
        temporary_.write("old.json", small_scene(2));
        temporary_.write("s.json", small_scene(4, R"("gravity": [0, -5, 0])"));
        run("old.json", "old");
        run("s.json", "new");
        old_ = files_in("old");
        new_ = files_in("new");
        EXPECT_NE(old_["sheet.pc2"], new_["sheet.pc2"]);
    }

    static std::vector<std::string> arguments(const std::string& scene, const std::string& to)
    {
        return {"simulate", scene, "-o", to, "--quiet", "--no-cache", "--report", to + "/run.json"};
    }

    void run(const std::string& scene, const std::string& to) const
    {
        EXPECT_EQ(run_toile(arguments(scene, to), folder_).exit_code, 0);
    }

    /// Names of the folder in a certificate are replaced; a report, which has times, by its number of frames.
    Files files_in(const std::string& name) const
    {
        Files files;
        for (const std::string& delivered : kDelivered)
            if (std::string bytes = bytes_of(file(name) / delivered); !bytes.empty()) {
                if (const size_t at = bytes.find(name + "/sheet.pc2"); at != std::string::npos)
                    bytes.replace(at, name.size(), "DIR");
                if (delivered == "run.json")
                    bytes = bytes.substr(bytes.find("\"frames\": "), 11);
                files[delivered] = bytes;
            }
        return files;
    }

    /// Whether a file lies under a name of unique_partial().
    bool is_waiting(const std::string& name) const
    {
        for (const auto& entry : std::filesystem::directory_iterator(file("out")))
            if (entry.path().filename().string().starts_with(name + ".partial-"))
                return true;
        return false;
    }

    void lay_out_the_earlier_run() const
    {
        std::filesystem::remove_all(file("out"));
        run("old.json", "out");
    }

    /// Where the earlier run is not whole, every file of the new one is there, some under their partial
    /// names.
    /// @return whether the earlier run is whole
    bool expect_old_or_new() const
    {
        Files found = files_in("out");
        for (const std::string& name : found == old_ ? std::vector<std::string>{} : kDelivered) {
            const path partial =
                file("out") / (path(name).stem().string() + ".partial" + path(name).extension().string());
            EXPECT_TRUE(found[name] == new_.at(name) || std::filesystem::exists(partial) || is_waiting(name))
                << name;
        }
        for (const auto& [name, bytes] : found)
            EXPECT_TRUE(bytes.empty() || bytes == old_.at(name) || bytes == new_.at(name)) << name;
        if (!found["certificate.json"].empty()) {
            const Files& described = found["certificate.json"] == old_.at("certificate.json") ? old_ : new_;
            EXPECT_EQ(found["sheet.pc2"], described.at("sheet.pc2"));
            EXPECT_EQ(found["sheet.obj"], described.at("sheet.obj"));
        }
        return files_in("out") == old_;
    }

    /// @return frames of the partial cache, which begins as the new one does; 0 where there is none
    int expect_readable_partial() const
    {
        const path partial = file("out/sheet.partial.pc2");
        if (!std::filesystem::exists(partial))
            return 0;
        const PointCache cache = read_cache(partial), whole = read_cache(file("new/sheet.pc2"));
        for (int frame = 0; frame < cache.frame_count(); ++frame)
            EXPECT_EQ(cache.frame(frame), whole.frame(frame));
        return cache.frame_count();
    }

    Files old_, new_;
};

TEST_F(Killed, AtAnyChangeOfAFileLeavesTheEarlierRunOrTheNewOne)
{
    lay_out_the_earlier_run();
    int points = 0, kept_old = 0, has_new = 0, partials = 0;
    while (true) {
        SCOPED_TRACE("change " + std::to_string(points));
        const KillResult result = kill_at(points, arguments("s.json", "out"), folder_);
        if (result == KillResult::Unsupported)
            GTEST_SKIP() << "no tracing here";
        if (result == KillResult::Ended)
            break;
        ++points;
        partials += expect_readable_partial() > 0 ? 1 : 0;
        has_new += files_in("out") == new_ ? 1 : 0;
        if (expect_old_or_new())
            ++kept_old;
        else
            lay_out_the_earlier_run();
    }
    EXPECT_EQ(files_in("out"), new_) << "the run that ended";
    EXPECT_GT(kept_old, 20);
    EXPECT_GT(partials, 10);
    RecordProperty("points", points);
    RecordProperty("earlier_run_whole", kept_old);
    RecordProperty("new_run_whole", has_new);
    RecordProperty("readable_partials", partials);
}

TEST_F(Killed, AtTenMomentsLeavesTheEarlierRunAndAReadablePartial)
{
    temporary_.write("s.json", small_scene(1000, R"("solver": {"sleep": {"enabled": false}})"));
    run("old.json", "out");
    const std::filesystem::path partial = file("out/sheet.partial.pc2");
    for (int moment = 0; moment < 10; ++moment) {
        const bool has_frames = moment % 2 == 1;
        std::filesystem::remove(partial);
        Running run(arguments("s.json", "out"), folder_);
        if (has_frames)
            Running::wait_for_file(partial);
        std::this_thread::sleep_for(std::chrono::milliseconds(10 * moment));
        run.end(SIGKILL);
        EXPECT_EQ(files_in("out"), old_) << moment;
        EXPECT_TRUE(std::filesystem::exists(partial) || !has_frames) << moment;
        if (std::filesystem::exists(partial)) {
            EXPECT_GE(read_cache(partial).frame_count(), 1);
        }
    }
}

/// Neither the end of ten minutes of settling nor that of a frame of a thousand steps is waited for.
TEST_F(Killed, ByASignalWithinALongStageEndsAtOnce)
{
    const std::pair<const char*, const char*> cases[] = {
        {R"("settle": 600, "solver": {"substeps": 1000, "sleep": {"enabled": false}})",
         "before the first frame"},
        {R"("solver": {"substeps": 1000, "velocity_tolerance": 1e-6, "sleep": {"enabled": false}})",
         "1 frame is in the partial caches"}};
    for (const auto& [keys, says] : cases) {
        temporary_.write("s.json", small_scene(1000000, keys));
        Running run(arguments("s.json", "out"), folder_);
        Running::wait_for_file(file("out/sheet.partial.pc2"));
        const Finished end = run.end(SIGINT);
        EXPECT_EQ(end.exit_code, 1);
        EXPECT_NE(end.errors.find("interrupted"), std::string::npos) << end.errors;
        EXPECT_NE(end.errors.find(says), std::string::npos) << end.errors;
    }
}

TEST(InterruptGuard, AsksForTheEndAtTheFirstSignalAndEndsAtALaterOne)
{
    const auto interrupt = [](std::chrono::milliseconds before_the_last) {
        const app::InterruptGuard guard;
        ::raise(SIGINT);
        ::raise(SIGTERM);
        std::this_thread::sleep_for(before_the_last);
        if (guard.requested())
            ::raise(SIGINT);
        ::_exit(0);
    };
    EXPECT_EXIT(interrupt(std::chrono::milliseconds(0)), testing::ExitedWithCode(0), "");
    EXPECT_EXIT(interrupt(std::chrono::milliseconds(600)), testing::KilledBySignal(SIGINT), "");
}

/// The end of a check of 50 000 frames is not waited for.
TEST_F(Killed, ByASignalBeforeAnythingIsWrittenLeavesNothing)
{
    temporary_.write("long.json", small_scene(50000));
    std::filesystem::create_directory(file("long"));
    const PointCache cache = read_cache(file("new/sheet.pc2"));
    CacheLayout layout;
    layout.meshes.emplace_back().vertex_count = cache.vertex_count();
    layout.frame_count = 50000;
    const auto writer = make_cache_writer(file("long/sheet.pc2"), layout);
    for (int frame = 0; frame < layout.frame_count; ++frame)
        writer->write(frame, cache.frame(0));
    writer->finish();
    Running check({"check", "long", "--scene", "long.json"}, folder_);
    Running::wait_for_file(file("long/.toile.lock"));
    const Finished end = check.end(SIGINT);
    EXPECT_EQ(end.exit_code, 1);
    EXPECT_EQ(end.error_lines(), 1) << end.errors;
    EXPECT_NE(end.errors.find("interrupted; nothing was written"), std::string::npos) << end.errors;
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(file("long")), {}), 1);
}

TEST_F(Killed, ByASignalThatCanBeCaughtEndsAfterItsFrame)
{
    temporary_.write("s.json", small_scene(1000000));
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        lay_out_the_earlier_run();
        Running run(arguments("s.json", "out"), folder_);
        Running::wait_for_file(file("out/sheet.partial.pc2"));
        const Finished end = run.end(signal);
        EXPECT_EQ(end.exit_code, 1);
        EXPECT_EQ(end.error_lines(), 1) << end.errors;
        EXPECT_EQ(end.output, "out/sheet.partial.pc2\n");
        EXPECT_NE(bytes_of(file("out/run.partial.json")).find("\"interrupted\""), std::string::npos);
        EXPECT_EQ(files_in("out"), old_);
        EXPECT_GE(read_cache(file("out/sheet.partial.pc2")).frame_count(), 1);
    }
    run("old.json", "out");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(file("out")), {}), 4)
        << "a run that finishes leaves no partials";
}

TEST_F(Killed, ByASignalKeepsAllFramesInEveryCache)
{
    temporary_.write("s.json", small_scene(300000, R"("export": [{"file": "a.abc", "subframes": 2},
        {"file": "b.pc2", "cloth": "sheet"}, {"file": "c.usda"}])"));
    Running run(arguments("s.json", "out"), folder_);
    Running::wait_for_file(file("out/b.partial.pc2"));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const Finished end = run.end(SIGINT);
    const int frames = read_cache(file("out/b.partial.pc2")).frame_count();
    const int samples = read_cache(file("out/a.partial.abc")).frame_count();
    EXPECT_TRUE(samples == 2 * frames - 1 || samples == 2 * frames) << samples << " of " << frames;
    EXPECT_NE(bytes_of(file("out/c.partial/c.usda")).find("endTimeCode = " + std::to_string(frames) + "\n"),
              std::string::npos);
    EXPECT_NE(end.errors.find("; " + std::to_string(frames) + (frames == 1 ? " frame is" : " frames are")),
              std::string::npos)
        << end.errors;
}

} // namespace
} // namespace toile::test
