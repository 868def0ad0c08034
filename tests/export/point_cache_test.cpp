#include "export/point_cache.h"

#include <gmock/gmock.h>

#include "tests/export/export_fixtures.h"
#include "tests/support/refusal.h"

namespace toile::test {

using namespace exports;

namespace {

using testing::AllOf;
using testing::HasSubstr;

class PointCacheTest : public ExportTest {
protected:
    /// Writes four frames of seven vertices at 25 frames a second, the first at scene frame 10.
    std::filesystem::path write_cache(const std::string& name) const
    {
        CacheLayout layout = cache_layout(quad_mesh(), 4);
        layout.fps = 25.0;
        layout.start_frame = 10.0;
        const auto writer = make_cache_writer(file(name), layout);
        write_frames(*writer, 0, 4, 7);
        writer->finish();
        return file(name);
    }

    std::string refusal_after(const std::string& name, const std::string& bytes) const
    {
        write_bytes(file(name), bytes);
        return refusal([&] { read_cache(file(name)); });
    }
};

TEST_F(PointCacheTest, ReadsEveryFrameInVertexOrder)
{
    for (const std::string name : {"a.pc2", "a.mdd", "a.obj", "a.abc", "a.ply"}) {
        const PointCache cache = read_cache(write_cache(name));
        ASSERT_EQ(cache.frame_count(), 4) << name;
        EXPECT_EQ(cache.vertex_count(), 7) << name;
        EXPECT_NEAR(cache.start_frame(), 10.0, 1e-5) << name;
        for (const int frame : {3, 0, 2, 1})
            EXPECT_EQ(cache.frame(frame), frame_positions(frame, 7)) << name;
        EXPECT_THAT(refusal([&] { (void)cache.frame(4); }), HasSubstr("frame 4")) << name;
    }
}

TEST_F(PointCacheTest, ReadsTheFrameRateOfMddOnly)
{
    EXPECT_NEAR(read_cache(write_cache("a.mdd")).fps().value_or(0.0), 25.0, 1e-4);
    EXPECT_FALSE(read_cache(write_cache("a.pc2")).fps().has_value());
}

TEST_F(PointCacheTest, ReportsTheFramesOfATruncatedFile)
{
    for (const std::string name : {"a.pc2", "a.mdd"}) {
        const std::string bytes = bytes_of(write_cache(name));
        EXPECT_THAT(refusal_after(name, bytes.substr(0, bytes.size() - 1)),
                    AllOf(HasSubstr(file(name).string()), HasSubstr("truncated at byte"),
                          HasSubstr("promises 4 frames"), HasSubstr("3 are complete")));
        EXPECT_THAT(refusal_after(name, bytes.substr(0, 5)), HasSubstr("ends at byte 5"));
        EXPECT_THAT(refusal_after(name, ""), HasSubstr("ends at byte 0"));
    }
}

TEST_F(PointCacheTest, RefusesOtherFiles)
{
    std::string bytes = bytes_of(write_cache("a.pc2"));
    EXPECT_THAT(refusal_after("a.pc2", bytes + "x"), HasSubstr("1 bytes follow the last frame at byte 368"));
    bytes[12] = 2;
    EXPECT_THAT(refusal_after("a.pc2", bytes), HasSubstr("version 2 (byte 12)"));
    bytes[0] = 'p';
    EXPECT_THAT(refusal_after("a.pc2", bytes), HasSubstr("no PC2 file"));

    // Counts in the wrong byte order: 4 becomes 67 million frames.
    bytes = bytes_of(write_cache("a.mdd"));
    std::reverse(bytes.begin(), bytes.begin() + 4);
    EXPECT_THAT(refusal_after("a.mdd", bytes), HasSubstr("MDD header"));
    EXPECT_THAT(refusal_after("a.mdd", bytes_of(write_cache("b.mdd")) + "x"), HasSubstr("1 bytes follow"));
    EXPECT_THAT(refusal_after("a.mdd", std::string(64, '\xff')), HasSubstr("no MDD file"));
}

TEST_F(PointCacheTest, RefusesByNameWhatIsForOtherProgramsOnly)
{
    for (const std::string name : {"a.glb", "a.pvd"})
        EXPECT_THAT(refusal([&] { read_cache(write_cache(name)); }),
                    HasSubstr(name +
                              ": is written for other programs, and not read as a cache; name the .pc2, "
                              ".mdd, .abc, .usda, .usdc, .usd, .obj or .ply of the run"));
}

TEST_F(PointCacheTest, NamesTheLineOfABrokenObj)
{
    EXPECT_THAT(refusal_after("a.obj", "v 0 0 0\nv 1 x 0\n"), HasSubstr("a.obj:2:"));
    EXPECT_THAT(refusal_after("a.obj", "v 0 0 0\n"), HasSubstr("has no faces"));
}

TEST_F(PointCacheTest, NamesAMissingFileAndAnUnknownExtension)
{
    EXPECT_THAT(refusal([&] { read_cache(file("none.pc2")); }), HasSubstr("none.pc2: can't be opened"));
    EXPECT_THAT(refusal([&] { read_cache(file("a.mc")); }),
                HasSubstr("use .pc2, .mdd, .abc, .usda, .usdc, .usd, .obj or .ply"));
}

} // namespace
} // namespace toile::test
