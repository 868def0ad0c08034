#include "export/cache_writer.h"

#include <csignal>

#include <gmock/gmock.h>
#include <sys/resource.h>

#include "tests/export/export_fixtures.h"
#include "tests/support/refusal.h"

namespace toile::test {

using namespace exports;

namespace {

using testing::HasSubstr;

using CacheWriterTest = ExportTest;

/// Writes one vertex (1, -2, 0.5), then (0, 0, 3), starting at scene frame 5.
void write_two_frames(const std::filesystem::path& file)
{
    CacheLayout layout;
    layout.meshes.emplace_back().vertex_count = 1;
    layout.frame_count = 2;
    layout.fps = 2.0;
    layout.start_frame = 5.0;
    const auto writer = make_cache_writer(file, layout);
    writer->write(0, std::vector<Vec3>{Vec3(1, -2, 0.5)});
    writer->write(1, std::vector<Vec3>{Vec3(0, 0, 3)});
    writer->finish();
}

// Bytes by hand from the formats' descriptions: 1.0f is 3f800000, -2.0f c0000000, 0.5f 3f000000, 3.0f
// 40400000, 5.0f 40a00000, 2.5f 40200000.
TEST_F(CacheWriterTest, WritesPc2ByteForByte)
{
    write_two_frames(file("a.pc2"));
    const char expected[] = "POINTCACHE2\0"
                            "\x01\0\0\0\x01\0\0\0\0\0\xa0\x40\0\0\x80\x3f\x02\0\0\0"
                            "\0\0\x80\x3f\0\0\0\xc0\0\0\0\x3f"
                            "\0\0\0\0\0\0\0\0\0\0\x40\x40";
    EXPECT_EQ(bytes_of(file("a.pc2")), std::string(expected, sizeof expected - 1));
}

TEST_F(CacheWriterTest, WritesMddByteForByte)
{
    write_two_frames(file("a.mdd"));
    const char expected[] = "\0\0\0\x02\0\0\0\x01\x40\x20\0\0\x40\x40\0\0" // 2 frames, 1 point, 2.5 s, 3 s
                            "\x3f\x80\0\0\xc0\0\0\0\x3f\0\0\0"
                            "\0\0\0\0\0\0\0\0\x40\x40\0\0";
    EXPECT_EQ(bytes_of(file("a.mdd")), std::string(expected, sizeof expected - 1));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1) << "only a.mdd remains";
}

TEST_F(CacheWriterTest, LeavesTheOldCacheIntactUntilItFinishes)
{
    for (const std::string name : {"a.pc2", "a.mdd", "a.obj", "a.abc", "a.ply", "a.glb", "a.pvd"}) {
        write_bytes(file(name), "precious");
        const auto writer = make_cache_writer(file(name), cache_layout(quad_mesh(), 1));
        writer->write(0, frame_positions(0, 7));
        EXPECT_EQ(bytes_of(file(name)), "precious") << name;
        EXPECT_TRUE(std::filesystem::exists(writer->partial()) || name == "a.pvd") // it waits for a velocity
            << name;
        writer->finish();
        EXPECT_NE(bytes_of(file(name)), "precious") << name;
        EXPECT_FALSE(std::filesystem::exists(writer->partial())) << name;
    }
}

TEST_F(CacheWriterTest, RefusesToFinishShortAndNamesThePartialFile)
{
    for (const std::string name : {"a.pc2", "a.mdd", "a.obj", "a.abc", "a.ply", "a.glb", "a.pvd"}) {
        const auto writer = make_cache_writer(file(name), cache_layout(quad_mesh(), 3));
        write_frames(*writer, 0, 2, 7);
        const std::string message = refusal([&] { writer->finish(); });
        EXPECT_THAT(message, HasSubstr("only 2 of 3 frames")) << name;
        EXPECT_THAT(message, HasSubstr(writer->partial().string())) << name;
        EXPECT_FALSE(std::filesystem::exists(file(name))) << name;
    }
}

TEST_F(CacheWriterTest, RefusesFramesOutOfOrderOrOfAnotherSize)
{
    const auto writer = make_cache_writer(file("a.pc2"), cache_layout(quad_mesh(), 2));
    EXPECT_THAT(refusal([&] { writer->write(1, frame_positions(1, 7)); }), HasSubstr("frame 1 came where"));
    EXPECT_THAT(refusal([&] { writer->write(0, frame_positions(0, 6)); }), HasSubstr("has 6 vertices"));
    write_frames(*writer, 0, 2, 7);
    EXPECT_THAT(refusal([&] { writer->write(2, frame_positions(2, 7)); }), HasSubstr("frame 2 came where"));
}

TEST_F(CacheWriterTest, RefusesAnUnwritablePathBeforeTheFirstFrame)
{
    write_bytes(file("plain"), "a file, not a folder");
    for (const std::string name : {"a.pc2", "a.mdd", "a.obj", "a_##.obj", "a.ply", "a.glb", "a.pvd"}) {
        const auto open = [&] { make_cache_writer(file("plain") / name, cache_layout(quad_mesh(), 1)); };
        EXPECT_THAT(refusal(open), HasSubstr("choose a writable folder")) << name;
    }
    std::filesystem::create_directory(file("folder.pc2"));
    EXPECT_THAT(refusal([&] { make_cache_writer(file("folder.pc2"), cache_layout(quad_mesh(), 1)); }),
                HasSubstr("is a folder"));
}

TEST_F(CacheWriterTest, CreatesMissingFolders)
{
    write_two_frames(file("new/deep/a.pc2"));
    EXPECT_EQ(read_cache(file("new/deep/a.pc2")).frame_count(), 2);
}

TEST_F(CacheWriterTest, RefusesLayoutsThatMakeNoCache)
{
    const auto message = [&](const char* name, const CacheLayout& layout) {
        return refusal([&] { make_cache_writer(file(name), layout); });
    };
    const CacheLayout good = cache_layout(quad_mesh(), 2);
    CacheLayout layout = good;
    layout.frame_count = 0;
    EXPECT_THAT(message("a.pc2", layout), HasSubstr("frame count is 0"));
    layout = good;
    layout.fps = 0.0;
    EXPECT_THAT(message("a.mdd", layout), HasSubstr("fps"));
    layout = good;
    layout.meshes[0].faces.polygons.clear();
    EXPECT_THAT(message("a.obj", layout), HasSubstr("needs faces"));
    layout = good;
    layout.meshes[0].vertex_count = 5;
    EXPECT_THAT(message("a.obj", layout), HasSubstr("uses vertex 5"));
    EXPECT_THAT(message("a.pc3", good),
                HasSubstr("use .pc2, .mdd, .abc, .usda, .usdc, .obj, .ply, .glb or .pvd"));
    EXPECT_TRUE(std::filesystem::is_empty(folder_)) << "a refused layout leaves nothing behind";
}

TEST_F(CacheWriterTest, KeepsThePartialOfAKilledRunUntilTheFirstFrame)
{
    const CacheLayout layout = cache_layout(quad_mesh(), 4);
    for (const char* name : {"a.pc2", "a.mdd", "a_####.obj", "a_####.ply"}) {
        std::filesystem::path partial;
        {
            const auto killed = make_cache_writer(file(name), layout);
            write_frames(*killed, 0, 3, 7);
            partial = name[1] == '_' ? killed->partial() / name : killed->partial();
        }
        const auto next = make_cache_writer(file(name), layout);
        EXPECT_EQ(read_cache(partial).frame_count(), 3) << name;
        next->write(0, frame_positions(0, 7));
        EXPECT_EQ(read_cache(partial).frame_count(), 1) << name;
    }
}

TEST_F(CacheWriterTest, CompletesUnderAPartialNameThatCanBeRead)
{
    for (const std::string name : {"a.pc2", "a.mdd", "a.obj", "a.abc", "a.ply"}) {
        write_bytes(file(name), "precious");
        const auto writer = make_cache_writer(file(name), cache_layout(quad_mesh(), 1));
        write_frames(*writer, 0, 1, 7);
        EXPECT_EQ(read_cache(writer->complete()).frame(0), frame_positions(0, 7)) << name;
        EXPECT_EQ(bytes_of(file(name)), "precious") << name;
        writer->publish();
        EXPECT_EQ(read_cache(file(name)).frame(0), frame_positions(0, 7)) << name;
    }
}

TEST_F(CacheWriterTest, KeepsTheFramesOfAnMddThatCannotBeCompleted)
{
    // The MDD is larger than its PC2 by the times of its frames, and the limit lies between.
    const auto writer = make_cache_writer(file("a.mdd"), cache_layout(quad_mesh(), 100));
    write_frames(*writer, 0, 100, 7);
    rlimit before{};
    ::getrlimit(RLIMIT_FSIZE, &before);
    const auto handler = ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{32 + 100 * 7 * 12 + 50, before.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    EXPECT_THROW(writer->complete(), DeviceError);
    ::setrlimit(RLIMIT_FSIZE, &before);
    ::signal(SIGXFSZ, handler);
    EXPECT_EQ(read_cache(writer->partial()).frame_count(), 100);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

TEST_F(CacheWriterTest, NoticesThatItsPartialWasRemoved)
{
    const auto writer = make_cache_writer(file("a.pc2"), cache_layout(quad_mesh(), 3));
    write_frames(*writer, 0, 1, 7);
    std::filesystem::remove(writer->partial());
    EXPECT_THROW(write_frames(*writer, 1, 2, 7), DeviceError);
}

TEST_F(CacheWriterTest, KeepsQuadsAndTextureCoordinatesInObj)
{
    const ObjMesh mesh = quad_mesh();
    const auto writer = make_cache_writer(file("one.obj"), cache_layout(mesh, 1));
    writer->write(0, frame_positions(0, 7));
    writer->finish();
    const ObjMesh read = read_obj(file("one.obj"));
    EXPECT_EQ(read.polygons, mesh.polygons);
    EXPECT_EQ(read.polygon_uvs, mesh.polygon_uvs);
    EXPECT_EQ(read.texture_coordinates, mesh.texture_coordinates);
    EXPECT_EQ(read.positions, frame_positions(0, 7));
}

} // namespace
} // namespace toile::test
