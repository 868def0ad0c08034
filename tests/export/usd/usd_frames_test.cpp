#include <gmock/gmock.h>

#include "export/byte_order.h"
#include "export/usd/usd_frames.h"
#include "tests/export/export_fixtures.h"
#include "tests/support/refusal.h"

namespace toile::test {

namespace {

using testing::HasSubstr;

/// A mesh and its frames as usd_commands.py writes them: a quad and a triangle of five points.
struct FrameFile {
    std::uint32_t points = 5, frames = 2, subframes = 1;
    double fps = 24.0, start = 10.0, metres = 1.0;
    std::uint32_t has_z_up = 0, is_clockwise = 0, scope = 1;
    std::vector<double> times; ///< irregular ones
    std::vector<std::int32_t> counts{4, 3}, corners{0, 1, 2, 3, 0, 3, 4};
    std::vector<float> texture{0, 0, 1, 0, 1, 1};
    std::vector<std::int32_t> at{0, 1, 2, 0, 1, 2, 0};
    std::vector<std::pair<std::string, std::vector<std::int32_t>>> groups{{"tip", {1}}};
    Eigen::Matrix4d world = Eigen::Matrix4d::Identity(); ///< of columns

    std::string bytes() const
    {
        std::string bytes = "ToileUSD";
        for (const std::uint32_t number : {points, frames, subframes})
            append(bytes, number);
        for (const double number : {fps, start, metres})
            append(bytes, number);
        for (const std::uint32_t number : {has_z_up, is_clockwise, scope})
            append(bytes, number);
        append_array(bytes, times, 1);
        append_array(bytes, counts, 1);
        append_array(bytes, corners, 1);
        append_array(bytes, texture, 2);
        append_array(bytes, at, 1);
        append(bytes, std::uint32_t(groups.size()));
        for (const auto& [name, faces] : groups) {
            append(bytes, std::uint32_t(name.size()));
            bytes += name;
            append_array(bytes, faces, 1);
        }
        for (std::uint32_t k = 0; k < frames; ++k) {
            for (int entry = 0; entry < 16; ++entry)
                append(bytes, world(entry % 4, entry / 4));
            for (const Vec3& x : frame_positions(int(k), int(points)))
                for (int axis = 0; axis < 3; ++axis)
                    append(bytes, float(x[axis]));
        }
        return bytes;
    }

    template <typename T>
    static void append_array(std::string& bytes, const std::vector<T>& values, std::uint32_t width)
    {
        append(bytes, std::uint32_t(values.size()) / width);
        for (const T value : values)
            append(bytes, value);
    }
};

class UsdFramesTest : public ExportTest {
protected:
    std::unique_ptr<const PointCache::Source> open(const FrameFile& frames) const
    {
        write_bytes(file("frames"), frames.bytes());
        return open_written();
    }
    std::unique_ptr<const PointCache::Source> open_written() const
    {
        return open_usd_frames(std::make_unique<BinaryFile>(file("frames"), BinaryFile::Mode::Read),
                               "shot.usda");
    }
    std::string said(const FrameFile& frames) const
    {
        return refusal([&] { open(frames); });
    }
};

TEST_F(UsdFramesTest, HoldsAMeshAndItsFrames)
{
    const auto cache = open({});
    std::filesystem::remove(file("frames"));
    EXPECT_EQ(cache->vertex_count, 5);
    EXPECT_EQ(cache->frame_count, 2);
    EXPECT_EQ(*cache->fps, 24.0);
    EXPECT_EQ(cache->start_frame, 10.0);
    EXPECT_EQ(*cache->axes, Axes{});
    EXPECT_EQ(cache->frame(1), frame_positions(1, 5));
    EXPECT_EQ(cache->mesh.positions, frame_positions(0, 5));
    EXPECT_EQ(cache->mesh.polygons, (std::vector<std::vector<int>>{{0, 1, 2, 3}, {0, 3, 4}}));
    EXPECT_EQ(cache->mesh.polygon_uvs, (std::vector<std::vector<int>>{{0, 1, 2, 0}, {1, 2, 0}}));
    EXPECT_EQ(cache->mesh.texture_coordinates[2], Vec2(1, 1));
    EXPECT_EQ(cache->mesh.groups, (std::vector<ObjGroup>{{1, "tip"}}));
}

TEST_F(UsdFramesTest, AppliesTransforms)
{
    FrameFile frames;
    frames.world << 0, -2, 0, 3, 2, 0, 0, 4, 0, 0, 2, 5, 0, 0, 0,
        1; // a quarter turn about Z, and a scale of 2
    const auto cache = open(frames);
    for (int v = 0; v < 5; ++v) {
        const Vec3 x = frame_positions(1, 5)[v];
        EXPECT_EQ(cache->frame(1)[v], Vec3(3 - 2 * x.y(), 4 + 2 * x.x(), 5 + 2 * x.z()));
    }
}

TEST_F(UsdFramesTest, FacesAreCounterClockwise)
{
    const std::vector<std::vector<int>> turned{{3, 2, 1, 0}, {4, 3, 0}}, kept{{0, 1, 2, 3}, {0, 3, 4}};
    FrameFile frames;
    frames.is_clockwise = 1;
    EXPECT_EQ(open(frames)->mesh.polygons, turned);
    EXPECT_EQ(open(frames)->mesh.polygon_uvs, (std::vector<std::vector<int>>{{0, 2, 1, 0}, {0, 2, 1}}));
    frames.world(0, 0) = -1.0; // a mirror turns them once more
    EXPECT_EQ(open(frames)->mesh.polygons, kept);
    frames.is_clockwise = 0;
    EXPECT_EQ(open(frames)->mesh.polygons, turned);
}

TEST_F(UsdFramesTest, KeepsMetresAndCentimetresAndConvertsOtherUnits)
{
    FrameFile frames;
    frames.metres = 0.01;
    frames.has_z_up = 1;
    EXPECT_EQ(*open(frames)->axes, (Axes{"cm", "z"}));
    EXPECT_EQ(open(frames)->frame(1), frame_positions(1, 5));
    const PointCache cache(open(frames));
    EXPECT_LT((cache.frame_in_metres(1)[2] - Vec3(0.015, -1.02, -0.0225)).norm(), 1e-15);
    frames.metres = 0.001;
    EXPECT_EQ(open(frames)->axes->unit, "m");
    EXPECT_EQ(open(frames)->frame(1)[2], Vec3(0.001 * frame_positions(1, 5)[2]));
}

TEST_F(UsdFramesTest, TakesTextureCoordinatesPerPoint)
{
    FrameFile frames;
    frames.scope = 2;
    frames.at = {0, 1, 2, 1, 0};
    EXPECT_EQ(open(frames)->mesh.polygon_uvs, (std::vector<std::vector<int>>{{0, 1, 2, 1}, {0, 1, 0}}));
    frames.at[4] = 3; // there is no such one
    EXPECT_TRUE(open(frames)->mesh.polygon_uvs.empty());
}

TEST_F(UsdFramesTest, HasTimesInsteadOfARateWhereTheyAreIrregular)
{
    FrameFile frames;
    frames.times = {0.5, 2.0};
    const auto cache = open(frames);
    EXPECT_EQ(cache->times, frames.times);
    EXPECT_FALSE(cache->fps);
    EXPECT_EQ(cache->frame(1), frame_positions(1, 5));
    frames.times = {0.5};
    EXPECT_THAT(said(frames), HasSubstr("has 1 times of 2 frames"));
    frames.times = {0.5, 0.5};
    EXPECT_THAT(said(frames), HasSubstr("sample 1 is at 0.5 s and the one before at 0.5 s"));
}

TEST_F(UsdFramesTest, IsRefusedWhereNumbersContradictEachOther)
{
    FrameFile frames;
    frames.corners[6] = 5;
    EXPECT_THAT(said(frames), HasSubstr("shot.usda: has a face of point 5; its points are 0 to 4"));
    frames = {};
    frames.counts[0] = 5;
    EXPECT_THAT(said(frames), HasSubstr("has a face of 3 corners; they have 3 to 10000, and 2 are left"));
    frames = {};
    frames.counts[1] = 2;
    EXPECT_THAT(said(frames), HasSubstr("has a face of 2 corners"));
    frames = {};
    frames.fps = 0.0;
    EXPECT_THAT(said(frames), HasSubstr("frames a second"));
    frames = {};
    frames.metres = -1.0;
    EXPECT_THAT(said(frames), HasSubstr("they must be positive"));
    frames = {};
    frames.points = 0;
    EXPECT_THAT(said(frames), HasSubstr("has 0 points"));
}

TEST_F(UsdFramesTest, NoSizeMakesItReadWhatIsNotThere)
{
    const std::string whole = FrameFile{}.bytes();
    for (size_t size = 0; size < whole.size(); ++size) {
        write_bytes(file("frames"), whole.substr(0, size));
        EXPECT_NE(refusal([&] { open_written(); }), "") << size;
    }
    for (size_t at = 0; at < whole.size(); ++at) {
        std::string broken = whole;
        broken[at] = char(broken[at] ^ 0xff);
        write_bytes(file("frames"), broken);
        try {
            open_written()->frame(1);
        } catch (const InvalidInput&) {
        }
    }
}

} // namespace

} // namespace toile::test
