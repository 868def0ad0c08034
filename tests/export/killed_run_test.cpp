#include <csignal>
#include <functional>

#include <gmock/gmock.h>
#include <sys/wait.h>

#include "tests/export/export_fixtures.h"
#include "tests/support/refusal.h"

namespace toile::test {

using namespace exports;

namespace {

using testing::HasSubstr;

class KilledRun : public ExportTest {
protected:
    /// Runs `simulate` in another process, which is killed at its end without clean-up.
    static void run_and_kill(const std::function<void()>& simulate)
    {
        const pid_t child = ::fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            simulate();
            ::raise(SIGKILL);
        }
        int status = 0;
        ::waitpid(child, &status, 0);
        ASSERT_TRUE(WIFSIGNALED(status));
    }

    /// Kills a run of 5 frames after 3.
    void kill_after_three(const std::string& name) const
    {
        run_and_kill([&] {
            const auto writer = make_cache_writer(file(name), cache_layout(quad_mesh(), 5));
            write_frames(*writer, 0, 3, 7);
        });
    }

    static void expect_frames(const std::filesystem::path& path, int count)
    {
        const PointCache cache = read_cache(path);
        ASSERT_EQ(cache.frame_count(), count) << path;
        for (int frame = 0; frame < count; ++frame)
            EXPECT_EQ(cache.frame(frame), frame_positions(frame, 7)) << path;
    }
};

TEST_F(KilledRun, LeavesAReadablePartialAndTheOldCache)
{
    write_bytes(file("skirt.pc2"), "precious");
    kill_after_three("skirt.pc2");
    expect_frames(file("skirt.partial.pc2"), 3);
    EXPECT_EQ(bytes_of(file("skirt.pc2")), "precious");

    kill_after_three("skirt.mdd");
    expect_frames(file("skirt.mdd.partial.pc2"), 3);

    kill_after_three("skirt.glb");
    expect_frames(file("skirt.glb.partial.pc2"), 3);

    for (const std::string extension : {".obj", ".ply"}) {
        kill_after_three("skirt" + extension);
        expect_frames(file("skirt.partial/skirt_####" + extension), 3);
    }
}

TEST_F(KilledRun, LeavesAReadablePartialWhenKilledWithinAFrame)
{
    kill_after_three("skirt.pc2");
    std::ofstream(file("skirt.partial.pc2"), std::ios::app | std::ios::binary) << "half of a frame";
    expect_frames(file("skirt.partial.pc2"), 3);
}

TEST_F(KilledRun, ResumesAtACheckpoint)
{
    for (const std::string name : {"skirt.pc2", "skirt.mdd", "skirt.obj", "skirt.ply"}) {
        kill_after_three(name);
        CacheLayout layout = cache_layout(quad_mesh(), 5);
        layout.resume_at = 2;
        const auto writer = make_cache_writer(file(name), layout);
        write_frames(*writer, 2, 5, 7);
        writer->finish();
        expect_frames(file(name), 5);
    }
}

TEST_F(KilledRun, LosesTheFramesBehindTheCheckpointWhenResumed)
{
    CacheLayout layout = cache_layout(quad_mesh(), 5);
    layout.resume_at = 2;
    kill_after_three("skirt.pc2");
    kill_after_three("skirt.obj");
    make_cache_writer(file("skirt.pc2"), layout);
    make_cache_writer(file("skirt.obj"), layout);
    expect_frames(file("skirt.partial.pc2"), 2);
    expect_frames(file("skirt.partial/skirt_####.obj"), 2);
}

TEST_F(KilledRun, RefusesToResumeMissingFrames)
{
    CacheLayout layout = cache_layout(quad_mesh(), 5);
    layout.resume_at = 4;
    const auto resume = [&](const char* name) {
        return refusal([&] { make_cache_writer(file(name), layout); });
    };
    for (const char* name : {"skirt.pc2", "skirt.mdd", "skirt.obj", "skirt.ply"}) {
        EXPECT_THAT(resume(name), HasSubstr("start the run anew")) << name;
        kill_after_three(name);
        EXPECT_THAT(resume(name), HasSubstr("start the run anew")) << name;
    }
}

} // namespace
} // namespace toile::test
