#include <csignal>

#include <gmock/gmock.h>

#include "export/alembic/abc_archive.h"
#include "export/alembic/abc_reader.h"
#include "export/alembic/abc_transform.h"
#include "export/byte_order.h"
#include "tests/export/export_fixtures.h"
#include "tests/support/refusal.h"

namespace toile::test {

namespace {

using testing::HasSubstr;

class AbcTest : public ExportTest {
protected:
    static constexpr double kFps = 25.0;

    static CacheLayout layout(int frames)
    {
        ObjMesh mesh = quad_mesh();
        mesh.groups = {{0, "front"}, {2, "back panel"}};
        CacheLayout layout = cache_layout(mesh, frames);
        layout.fps = kFps;
        layout.start_frame = 1001.0;
        return layout;
    }

    std::filesystem::path written(int frames) const
    {
        const auto writer = make_cache_writer(file("skirt.abc"), layout(frames));
        write_frames(*writer, 0, frames, 7);
        writer->finish();
        return file("skirt.abc");
    }

    /// A numbered sample of vectors of the only mesh.
    static std::vector<Vec3> vectors(const AbcReader& reader, const std::string& name, int sample)
    {
        const auto property = reader.find(reader.objects()[2].properties, {".geom", name});
        const std::string bytes = reader.sample(*property, sample);
        std::vector<Vec3> all;
        for (size_t k = 0; k < bytes.size(); k += 12)
            all.push_back(
                Vec3(take<float>(&bytes[k]), take<float>(&bytes[k + 4]), take<float>(&bytes[k + 8])));
        return all;
    }
};

TEST_F(AbcTest, ReadsBackWhatItWrites)
{
    const PointCache cache = read_cache(written(40));
    ASSERT_EQ(cache.frame_count(), 40);
    EXPECT_EQ(cache.vertex_count(), 7);
    EXPECT_NEAR(*cache.fps(), kFps, 1e-9);
    EXPECT_NEAR(cache.start_frame(), 1001.0, 1e-6);
    for (int k = 0; k < 40; ++k)
        EXPECT_EQ(cache.frame(k), frame_positions(k, 7)) << k;
    const ObjMesh expected = quad_mesh();
    ASSERT_TRUE(cache.mesh());
    EXPECT_EQ(cache.mesh()->polygons, expected.polygons);
    EXPECT_EQ(cache.mesh()->polygon_uvs, expected.polygon_uvs);
    EXPECT_EQ(cache.mesh()->texture_coordinates, expected.texture_coordinates);
    EXPECT_EQ(cache.mesh()->groups, (std::vector<ObjGroup>{{0, "front"}, {2, "back_panel"}}));
}

/// Frame k of the fixture moves each vertex by (1, 0, -100) m.
TEST_F(AbcTest, StoresVelocitiesPerSecond)
{
    const AbcReader reader(written(5));
    for (int k = 0; k < 5; ++k)
        for (const Vec3& v : vectors(reader, ".velocities", k))
            EXPECT_EQ(v, Vec3(kFps, 0.0, -100.0 * kFps)) << k;
}

TEST_F(AbcTest, PutsATransformAboveTheMeshAndASetUnderItForEachGroup)
{
    const AbcReader reader(written(2));
    std::vector<std::string> paths;
    paths.reserve(reader.objects().size());
    for (int k = 0; k < int(reader.objects().size()); ++k)
        paths.push_back(reader.path_of(k));
    EXPECT_EQ(paths, (std::vector<std::string>{"", "/skirt", "/skirt/skirtShape", "/skirt/skirtShape/front",
                                               "/skirt/skirtShape/back_panel"}));
    EXPECT_TRUE(reader.objects()[1].is("Xform"));
    EXPECT_TRUE(reader.objects()[2].is("PolyMesh"));
    EXPECT_TRUE(reader.objects()[3].is("FaceSet"));
}

TEST_F(AbcTest, HoldsSeveralMeshes)
{
    const ObjMesh faces = layout(1).meshes[0].faces;
    CacheLayout two;
    two.frame_count = 3;
    two.meshes = {{"skirt", "", 7, faces}, {"7 vest", "", 7, faces}};
    const auto writer = make_cache_writer(file("all.abc"), two);
    for (int k = 0; k < two.frame_count; ++k) {
        std::vector<Vec3> positions = frame_positions(k, 7);
        for (const Vec3& x : frame_positions(k + 10, 7))
            positions.push_back(x);
        writer->write(k, positions);
    }
    writer->finish();
    EXPECT_EQ(read_cache(file("all.abc#/_7_vest/_7_vestShape")).frame(2), frame_positions(12, 7));
    EXPECT_EQ(read_cache(file("all.abc#/skirt/skirtShape")).frame(2), frame_positions(2, 7));
    EXPECT_THAT(refusal([&] { read_cache(file("all.abc")); }),
                HasSubstr("name one behind #: /skirt/skirtShape, /_7_vest/_7_vestShape"));
    EXPECT_THAT(refusal([&] { read_cache(file("all.abc#/vest")); }),
                HasSubstr("all.abc: has no mesh /vest; its meshes are /skirt/skirtShape"));
    EXPECT_THAT(refusal([&] { make_cache_writer(file("all.pc2"), two); }),
                HasSubstr("all.pc2: holds one mesh, and there are 2"));
    two.meshes[0].name = "a b";
    two.meshes[1].name = "a-b";
    EXPECT_THAT(refusal([&] { make_cache_writer(file("two.abc"), two); }),
                HasSubstr("two meshes would be called \"a_b\""));
}

/// Frames that a killed writer leaves, from the number that it has been given.
TEST_F(AbcTest, IsReadableWhenItsWriterIsKilled)
{
    for (const auto& [given, left] : std::vector<std::pair<int, int>>{{3, 2}, {10, 9}, {20, 19}, {35, 29}}) {
        const auto writer = make_cache_writer(file("skirt.abc"), layout(100));
        write_frames(*writer, 0, given, 7);
        // What the file holds now is what a killed process leaves: nothing waits in it but in memory.
        std::filesystem::copy_file(writer->partial(), file("killed.abc"),
                                   std::filesystem::copy_options::overwrite_existing);
        const PointCache cache = read_cache(file("killed.abc"));
        ASSERT_EQ(cache.frame_count(), left) << given;
        for (int k = 0; k < left; ++k)
            EXPECT_EQ(cache.frame(k), frame_positions(k, 7)) << k;
    }
}

/// samples/make_samples.py, which wrote the file with Alembic's own library, says what is in it.
TEST_F(AbcTest, ReadsArchivesOfOthersUnderTheirTransforms)
{
    const PointCache cache = read_cache(TOILE_SOURCE_DIR "/tests/export/alembic/samples/moving_quad.abc");
    ASSERT_EQ(cache.frame_count(), 4);
    EXPECT_NEAR(*cache.fps(), 24.0, 1e-9);
    EXPECT_NEAR(cache.start_frame(), 10.0, 1e-9);
    for (int frame = 0; frame < 4; ++frame)
        for (int k = 0; k < 5; ++k)
            EXPECT_LT((cache.frame(frame)[k] - Vec3(frame - 2 * frame, 2 * k, 0)).norm(), 1e-14);
    const ObjMesh& mesh = *cache.mesh();
    EXPECT_EQ(mesh.polygons, (std::vector<std::vector<int>>{{0, 1, 2, 3}, {0, 3, 4}}));
    EXPECT_EQ(mesh.polygon_uvs, (std::vector<std::vector<int>>{{3, 2, 1, 0}, {6, 5, 4}}));
    EXPECT_EQ(mesh.texture_coordinates[5], Vec2(5, 2.5));
    EXPECT_EQ(mesh.groups, (std::vector<ObjGroup>{{1, "tip"}}));
}

TEST_F(AbcTest, HasTheFramesOfItsTransformWhereTheMeshIsStill)
{
    const PointCache cache = read_cache(TOILE_SOURCE_DIR "/tests/export/alembic/samples/moving_still.abc");
    ASSERT_EQ(cache.frame_count(), 4);
    EXPECT_NEAR(*cache.fps(), 24.0, 1e-9);
    for (int frame = 0; frame < 4; ++frame)
        EXPECT_EQ(cache.frame(frame)[3], Vec3(3, 2 * frame, 0)) << frame;
}

TEST_F(AbcTest, IsRefusedWithItsPlaceWhereItIsBroken)
{
    const std::string whole = bytes_of(written(3));
    const auto said = [&](const std::string& bytes) {
        write_bytes(file("bad.abc"), bytes);
        return refusal([&] { read_cache(file("bad.abc")).frame(0); });
    };
    EXPECT_THAT(said("Ogawa"), HasSubstr("bad.abc: does not start with Ogawa (byte 0)"));
    EXPECT_THAT(said("\x89HDF\r\n" + whole), HasSubstr("old HDF5 kind"));
    std::string incomplete = whole;
    incomplete[5] = 0;
    EXPECT_THAT(said(incomplete), HasSubstr("has not completed it (byte 5)"));
    EXPECT_THAT(said(whole.substr(0, whole.size() / 2)), HasSubstr("file of"));
    // No byte that differs makes it crash, or read what is not in the file.
    const std::string moving = bytes_of(TOILE_SOURCE_DIR "/tests/export/alembic/samples/moving_quad.abc");
    for (const std::string& intact : {whole, moving})
        for (size_t at = 8; at < intact.size(); at += 3) {
            std::string broken = intact;
            broken[at] = char(broken[at] ^ 0x55);
            write_bytes(file("bad.abc"), broken);
            try {
                read_cache(file("bad.abc")).frame(1);
            } catch (const InvalidInput&) {
            }
        }
}

TEST_F(AbcTest, CannotBeContinued)
{
    CacheLayout later = layout(4);
    later.resume_at = 2;
    EXPECT_THAT(refusal([&] { make_cache_writer(file("skirt.abc"), later); }),
                HasSubstr("can't be continued"));
}

} // namespace

} // namespace toile::test
