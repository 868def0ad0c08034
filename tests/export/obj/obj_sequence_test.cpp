#include "export/sequence/numbered_files.h"

#include <gmock/gmock.h>

#include "tests/export/export_fixtures.h"
#include "tests/support/refusal.h"

namespace toile::test {

using namespace exports;

namespace {

using testing::HasSubstr;

using ObjSequenceTest = ExportTest;

void write_sequence(const std::filesystem::path& pattern, int frames, double start_frame)
{
    CacheLayout layout = cache_layout(quad_mesh(), frames);
    layout.start_frame = start_frame;
    const auto writer = make_cache_writer(pattern, layout);
    write_frames(*writer, 0, frames, 7);
    writer->finish();
}

TEST_F(ObjSequenceTest, NamesFramesByTheirNumber)
{
    const NumberedFiles sequence("out/skirt.obj");
    EXPECT_EQ(sequence.file(1), "out/skirt_0001.obj");
    EXPECT_EQ(sequence.file(12345), "out/skirt_12345.obj");
    EXPECT_EQ(NumberedFiles("f.##.obj").file(7), "f.07.obj");
    EXPECT_EQ(sequence.stem(), "skirt");
    EXPECT_EQ(sequence.number_of("skirt_0010.obj"), 10);
    EXPECT_EQ(sequence.number_of("skirt_12345.obj"), 12345);
    for (const char* foreign : {"skirt_010.obj", "skirt_00010.obj", "skirt_001a.obj", "skirt.obj", "a.obj"})
        EXPECT_FALSE(sequence.number_of(foreign)) << foreign;
}

TEST_F(ObjSequenceTest, KeepsQuadsAndTextureCoordinatesInEveryFrame)
{
    write_sequence(file("skirt.obj"), 3, 1.0);
    const ObjMesh mesh = quad_mesh();
    for (int number = 1; number <= 3; ++number) {
        const ObjMesh frame = read_obj(file("skirt_000" + std::to_string(number) + ".obj"));
        EXPECT_EQ(frame.polygons, mesh.polygons);
        EXPECT_EQ(frame.polygon_uvs, mesh.polygon_uvs);
        EXPECT_EQ(frame.positions, frame_positions(number - 1, 7));
    }
    EXPECT_FALSE(std::filesystem::exists(file("skirt.partial")));
}

TEST_F(ObjSequenceTest, ReadsBackInOrderWithItsFaces)
{
    write_sequence(file("skirt.obj"), 12, 95.0);
    for (const char* name : {"skirt.obj", "skirt_####.obj"}) {
        const PointCache cache = read_cache(file(name));
        ASSERT_EQ(cache.frame_count(), 12);
        EXPECT_EQ(cache.start_frame(), 95.0);
        EXPECT_EQ(cache.frame(11), frame_positions(11, 7));
        ASSERT_NE(cache.mesh(), nullptr);
        EXPECT_EQ(cache.mesh()->polygons, quad_mesh().polygons);
    }
}

TEST_F(ObjSequenceTest, RemovesTheTailOfALongerEarlierRun)
{
    write_sequence(file("skirt.obj"), 5, 0.0);
    write_bytes(file("skirt_0009.obj"), "not a continuation");
    write_sequence(file("skirt.obj"), 3, 0.0);
    EXPECT_EQ(NumberedFiles(file("skirt.obj")).existing(), (std::vector<int>{0, 1, 2, 9}));
}

TEST_F(ObjSequenceTest, KeepsTheEarlierSequenceUntilTheNewOneIsComplete)
{
    write_sequence(file("skirt.obj"), 3, 0.0);
    const std::string before = bytes_of(file("skirt_0001.obj"));
    {
        const auto writer = make_cache_writer(file("skirt.obj"), cache_layout(quad_mesh(), 3));
        writer->write(0, frame_positions(7, 7));
        writer->write(1, frame_positions(8, 7));
    }
    EXPECT_EQ(bytes_of(file("skirt_0001.obj")), before);
    EXPECT_EQ(read_cache(file("skirt.partial/skirt.obj")).frame_count(), 2);
}

/// Vertices come before faces: wherever a file is cut off, a face is missing or another one.
TEST_F(ObjSequenceTest, RefusesAFrameThatIsCutOff)
{
    for (const std::string cut : {"skirt_0000.obj", "skirt_0001.obj"}) {
        write_sequence(file("skirt.obj"), 2, 0.0);
        const std::string whole = bytes_of(file(cut));
        for (size_t size = 0; size + 1 < whole.size(); ++size) {
            write_bytes(file(cut), whole.substr(0, size));
            const std::string said = refusal([&] { read_cache(file("skirt.obj")).frame(1); });
            EXPECT_THAT(said, HasSubstr(".obj")) << cut << " cut off at byte " << size;
        }
    }
    write_sequence(file("skirt.obj"), 2, 0.0);
    std::string other = bytes_of(file("skirt_0001.obj"));
    other.resize(other.rfind("\nf"));
    write_bytes(file("skirt_0001.obj"), other);
    EXPECT_THAT(
        refusal([&] { read_cache(file("skirt.obj")).frame(1); }),
        HasSubstr("skirt_0001.obj: has 2 faces and " + file("skirt_0000.obj").string() +
                  " 3; all frames of a sequence need the same mesh, and one of these is of another or "
                  "cut off"));
}

TEST_F(ObjSequenceTest, NamesTheMissingAndTheMisfittingFrame)
{
    write_sequence(file("skirt.obj"), 4, 0.0);
    write_bytes(file("skirt_0003.obj"), "v 0 0 0\n");
    EXPECT_THAT(refusal([&] { read_cache(file("skirt.obj")).frame(3); }),
                HasSubstr("skirt_0003.obj: has 1 vertices"));
    std::filesystem::remove(file("skirt_0002.obj"));
    EXPECT_THAT(refusal([&] { read_cache(file("skirt.obj")); }), HasSubstr("skirt_0002.obj: missing"));
    EXPECT_THAT(refusal([&] { read_cache(file("coat.obj")); }), HasSubstr("coat.obj: can't be found"));
}

} // namespace
} // namespace toile::test
