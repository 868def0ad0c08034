#include "export/async_cache_writer.h"

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include "core/base/error.h"
#include "tests/export/export_fixtures.h"

namespace toile::test {

using namespace exports;

namespace {

using AsyncCacheWriterTest = ExportTest;

TEST_F(AsyncCacheWriterTest, WritesTheSameBytesAsASynchronousWriter)
{
    const CacheLayout layout = cache_layout(quad_mesh(), 40);
    const auto direct = make_cache_writer(file("direct.pc2"), layout);
    write_frames(*direct, 0, 40, 7);
    direct->finish();

    AsyncCacheWriter queued(make_cache_writer(file("queued.pc2"), layout), 3);
    std::vector<Vec3> positions;
    for (int frame = 0; frame < 40; ++frame) {
        positions = frame_positions(frame, 7);
        queued.write(frame, positions);
        positions.assign(positions.size(), Vec3::Zero()); // must not reach the file
    }
    queued.finish();
    EXPECT_EQ(bytes_of(file("queued.pc2")), bytes_of(file("direct.pc2")));
}

/// Late positions are requested once, by the writer thread, and released when they are written.
TEST_F(AsyncCacheWriterTest, RequestsLatePositionsOnTheWriterThread)
{
    const CacheLayout layout = cache_layout(quad_mesh(), 9);
    const auto direct = make_cache_writer(file("direct.pc2"), layout);
    write_frames(*direct, 0, 9, 7);
    direct->finish();

    AsyncCacheWriter later(make_cache_writer(file("later.pc2"), layout), 3);
    std::vector<std::weak_ptr<const std::vector<Vec3>>> given;
    std::atomic<int> asked = 0, asked_here = 0;
    for (int frame = 0; frame < 9; ++frame) {
        const auto positions = std::make_shared<const std::vector<Vec3>>(frame_positions(frame, 7));
        given.push_back(positions);
        later.write_later(frame, [&, positions, caller = std::this_thread::get_id()]() -> CacheSample {
            ++asked;
            asked_here += std::this_thread::get_id() == caller;
            return {*positions, {}};
        });
    }
    later.finish();
    EXPECT_EQ(bytes_of(file("later.pc2")), bytes_of(file("direct.pc2")));
    EXPECT_EQ(asked, 9);
    EXPECT_EQ(asked_here, 0);
    for (const auto& positions : given)
        EXPECT_TRUE(positions.expired());
}

TEST_F(AsyncCacheWriterTest, RethrowsErrorsOfLatePositions)
{
    AsyncCacheWriter writer(make_cache_writer(file("a.pc2"), cache_layout(quad_mesh(), 9)), 2);
    writer.write(0, frame_positions(0, 7));
    writer.write_later(1, []() -> CacheSample { throw DeviceError("the GPU is gone"); });
    EXPECT_THROW(writer.finish(), DeviceError);
    EXPECT_EQ(writer.close(), 1);
    EXPECT_EQ(read_cache(file("a.partial.pc2")).frame_count(), 1);
}

TEST_F(AsyncCacheWriterTest, WritesQueuedFramesWhenDestroyed)
{
    {
        AsyncCacheWriter writer(make_cache_writer(file("a.pc2"), cache_layout(quad_mesh(), 9)));
        write_frames(writer, 0, 4, 7);
    }
    EXPECT_EQ(read_cache(file("a.partial.pc2")).frame_count(), 4);
    EXPECT_FALSE(std::filesystem::exists(file("a.pc2")));
}

/// What waited for a next frame is not lost with it.
TEST_F(AsyncCacheWriterTest, KeepsAllDeliveredFramesWhenClosed)
{
    for (const char* name : {"a.pc2", "a.mdd", "a.abc", "a_####.ply", "a.pvd", "a.glb", "a.usda"}) {
        CacheLayout layout = cache_layout(quad_mesh(), 200);
        AsyncCacheWriter writer(make_cache_writer(file(name), layout));
        write_frames(writer, 0, 70, 7);
        writer.write_later(70, []() -> CacheSample { throw DeviceError("the GPU is gone"); });
        EXPECT_EQ(writer.close(), 70) << name;
        EXPECT_EQ(writer.close(), 70) << name;
    }
    EXPECT_EQ(read_cache(file("a.partial.pc2")).frame_count(), 70);
    EXPECT_EQ(read_cache(file("a.partial.abc")).frame_count(), 70);
    EXPECT_EQ(read_cache(file("a.partial.abc")).frame(69), frame_positions(69, 7));
    EXPECT_EQ(read_cache(file("a.partial/a_####.ply")).frame_count(), 70);
    EXPECT_TRUE(std::filesystem::exists(file("a.partial/a_0069.vtu")));
    EXPECT_NE(bytes_of(file("a.partial/a.usda")).find("endTimeCode = 69\n"), std::string::npos);
}

/// Disk that is slow and full from frame 3 on.
class FullDisk final : public CacheWriter {
public:
    explicit FullDisk(std::vector<int>& written) : written_(written) {}
    void write(int frame, const SampleView&) override
    {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        if (frame == 3)
            throw DeviceError("disk full");
        written_.push_back(frame);
    }
    std::filesystem::path complete() override { return {}; }
    void publish() override { written_.push_back(-1); }
    std::filesystem::path partial() const override { return {}; }
    void keep() override { written_.push_back(-2); }
    int readable_samples() const override { return int(written_.size()); }

private:
    std::vector<int>& written_;
};

TEST_F(AsyncCacheWriterTest, RethrowsAnErrorAtALaterWriteAndWritesNothingMore)
{
    std::vector<int> written;
    AsyncCacheWriter writer(std::make_unique<FullDisk>(written), 2);
    EXPECT_THROW(write_frames(writer, 0, 100, 7), DeviceError);
    EXPECT_THROW(writer.finish(), DeviceError);
    EXPECT_EQ(written, (std::vector<int>{0, 1, 2}));
}

TEST_F(AsyncCacheWriterTest, RethrowsTheErrorOfTheLastFrameAtFinish)
{
    std::vector<int> written;
    AsyncCacheWriter writer(std::make_unique<FullDisk>(written), 8);
    write_frames(writer, 0, 4, 7);
    EXPECT_THROW(writer.finish(), DeviceError);
    EXPECT_EQ(written, (std::vector<int>{0, 1, 2}));
}

} // namespace
} // namespace toile::test
