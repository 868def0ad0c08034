#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "export/cache_writer.h"
#include "export/point_cache.h"
#include "tests/apps/program.h"

namespace toile::test {

using namespace exports;

namespace {

using testing::HasSubstr;

class ConvertTest : public FileTest {
protected:
    /// A triangle in three frames, the second vertex at (1 + frame, 2, -3).
    void write(const std::string& name) const
    {
        ObjMesh mesh;
        mesh.positions = {{0, 0, 0}, {1, 2, -3}, {0, 1, 0}};
        mesh.polygons = {{0, 1, 2}};
        CacheLayout layout = cache_layout(mesh, kFrames);
        layout.fps = 25.0;
        const auto writer = make_cache_writer(file(name), layout);
        for (int frame = 0; frame < kFrames; ++frame) {
            mesh.positions[1].x() = 1 + frame;
            writer->write(frame, mesh.positions);
        }
        writer->finish();
    }
    Finished convert(std::vector<std::string> arguments) const
    {
        arguments.insert(arguments.begin(), "convert");
        arguments.push_back("--quiet");
        return run_toile(arguments, folder_);
    }
    void expect_refused(const std::vector<std::string>& arguments, const std::string& says) const
    {
        const auto before = temporary_.snapshot();
        const Finished run = convert(arguments);
        EXPECT_EQ(run.exit_code, 2);
        EXPECT_EQ(run.error_lines(), 1) << run.errors;
        EXPECT_THAT(run.errors, HasSubstr(says));
        EXPECT_EQ(temporary_.snapshot(), before) << says;
    }

    static constexpr int kFrames = 3;
};

TEST_F(ConvertTest, ThroughAllFormatsAndBackGivesTheSameBytes)
{
    write("a.pc2");
    write("mesh_##.obj");
    const std::vector<std::string> chain{"a.pc2", "b.abc", "c.mdd", "d_##.obj", "e.abc", "e_##.ply", "f.pc2"};
    for (size_t k = 0; k + 1 < chain.size(); ++k) {
        const Finished run = convert({chain[k], chain[k + 1], "--mesh", "mesh_00.obj", "--fps", "25"});
        EXPECT_EQ(run.exit_code, 0) << run.errors;
    }
    EXPECT_EQ(bytes_of(file("f.pc2")), bytes_of(file("a.pc2")));
    EXPECT_NEAR(*read_cache(file("e.abc")).fps(), 25.0, 1e-9);
}

TEST_F(ConvertTest, KeepsRateAndFirstFrameAsTheyWereSaid)
{
    write("a.abc");
    write("mesh_##.obj");
    for (const std::string fps : {"24", "24000/1001"})
        for (const std::string to : {"b.mdd", "b.abc"}) {
            EXPECT_EQ(convert({"a.abc", to, "--fps", fps, "--start-frame", "1001"}).exit_code, 0);
            EXPECT_EQ(*read_cache(file(to)).fps(), fps == "24" ? 24.0 : 24000.0 / 1001.0) << to;
            EXPECT_EQ(read_cache(file(to)).start_frame(), 1001.0) << to;
            const std::string frames = to + fps.substr(0, 5) + "_####.obj";
            EXPECT_EQ(convert({to, frames, "--mesh", "mesh_00.obj"}).exit_code, 0);
            EXPECT_TRUE(std::filesystem::exists(file(to + fps.substr(0, 5) + "_1003.obj")));
        }
}

TEST_F(ConvertTest, ChangesUnitAxesAndFirstFrame)
{
    write("a.abc");
    convert({"a.abc", "b.abc", "--unit", "cm", "--up", "z", "--start-frame", "1001"});
    const PointCache changed = read_cache(file("b.abc"));
    EXPECT_EQ(changed.frame(2)[1], Vec3(300, 300, 200));
    EXPECT_NEAR(changed.start_frame(), 1001.0, 1e-6);
    convert({"b.abc", "c.abc"}); // the archive says its unit and axis
    EXPECT_EQ(read_cache(file("c.abc")).frame(2)[1], Vec3(3, 2, -3));
    convert({"b.abc", "d.mdd"});
    EXPECT_EQ(read_cache(file("d.mdd")).frame(2)[1], Vec3(3, 2, -3));
}

TEST_F(ConvertTest, SparesWhatItReads)
{
    write("a.partial.abc");
    write("s_##.obj");
    write("a.pc2");
    expect_refused({"a.partial.abc", "a.abc"}, "would replace a.partial.abc, the cache");
    expect_refused({"s_01.obj", "s_##.obj"}, "would replace s_01.obj, the cache");
    expect_refused({"a.pc2", "s_##.obj", "--mesh", "s_02.obj"}, "would replace s_02.obj, the mesh");
    expect_refused({"a.pc2", "a.pc2"}, "would replace a.pc2, the cache");
}

TEST_F(ConvertTest, RefusesWhatCannotBeInOneLine)
{
    write("a.pc2");
    write("a.abc");
    expect_refused({"a.pc2", "b.abc"},
                   "a.pc2: has no faces, which b.abc needs; name the mesh that it plays on "
                   "with --mesh");
    expect_refused({"a.abc", "b.abc#/x"}, "names a mesh in an archive");
    expect_refused({"a.abc", "b.pc2", "--unit", "ft"}, "--unit ft: is no unit of caches; write m or cm");
    expect_refused({"a.abc", "b.pc2", "--fps", "0"}, "--fps");
    expect_refused({"a.abc", "b_##.obj", "--start-frame", "1.5"}, "must be a whole number");
    expect_refused({"a.abc#/b", "b.pc2"}, "a.abc: has no mesh /b; its meshes are /a/aShape");
}

/// tests/export/alembic/samples/make_samples.py says what is in it.
TEST_F(ConvertTest, ResamplesIrregularTimesAtAGivenRate)
{
    std::filesystem::copy(TOILE_SOURCE_DIR "/tests/export/alembic/samples/irregular.abc", file("a.abc"));
    expect_refused({"a.abc#/mover/square", "b.abc"},
                   "has samples at irregular times, from 0 to 1.7 s; give --fps to resample it at this rate");
    ASSERT_EQ(convert({"a.abc#/mover/square", "b.abc", "--fps", "20"}).exit_code, 0);
    const PointCache cache = read_cache(file("b.abc"));
    EXPECT_EQ(*cache.fps(), 20.0);
    ASSERT_EQ(cache.frame_count(), 35);
    EXPECT_LT((cache.frame(3)[2] - Vec3(2.5, 1.5, 0.0)).norm(), 1e-6) << "0.15 s";
    EXPECT_EQ(cache.frame(34)[2], Vec3(6, 4, 0));
    const std::string info = run_toile({"info", "a.abc"}, folder_).output;
    EXPECT_THAT(info, HasSubstr("mesh: /mover/square\n"));
    EXPECT_THAT(info, HasSubstr("frames: 7\n"));
    EXPECT_THAT(info, HasSubstr("times: irregular, 0 to 1.7 s\n"));
}

/// Two panels in nine samples, four a frame, that rises by 1 m a sample.
class ConvertPanels : public ConvertTest {
protected:
    void SetUp() override
    {
        ObjMesh mesh;
        mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 0, -1}, {0, 0, -1}, {2, 0, 0}, {2, 0, -1}};
        mesh.polygons = {{0, 1, 2, 3}, {1, 4, 5, 2}};
        mesh.groups = {{0, "left"}, {1, "right"}};
        CacheLayout layout = cache_layout(mesh, 9);
        layout.subframes = 4;
        layout.start_frame = 5.0;
        const auto writer = make_cache_writer(file("tee.abc"), layout);
        for (int k = 0; k < 9; ++k) {
            for (Vec3& x : mesh.positions)
                x.y() = k;
            writer->write(k, mesh.positions);
        }
        writer->finish();
    }
};

TEST_F(ConvertPanels, ClosesThemWithAThickness)
{
    ASSERT_EQ(convert({"tee.abc", "b.abc", "--thickness", "0.02", "--unit", "cm"}).exit_code, 0);
    const PointCache cache = read_cache(file("b.abc"));
    ASSERT_EQ(cache.vertex_count(), 12);
    EXPECT_EQ(cache.mesh()->polygons.size(), 4u + 6u) << "two sides and a rim";
    EXPECT_LT((cache.frame(8)[0] - Vec3(0, 801, 0)).norm(), 1e-4);
    EXPECT_LT((cache.frame(8)[6] - Vec3(0, 799, 0)).norm(), 1e-4);
}

TEST_F(ConvertPanels, WritesAMeshForEach)
{
    ASSERT_EQ(convert({"tee.abc", "b.abc", "--no-weld"}).exit_code, 0);
    const std::string archive = file("b.abc").string();
    EXPECT_EQ(meshes_of_cache(archive),
              (std::vector<std::filesystem::path>{archive + "#/tee/left/leftShape",
                                                  archive + "#/tee/right/rightShape"}));
    EXPECT_EQ(read_cache(archive + "#/tee/right/rightShape").frame(3),
              (std::vector<Vec3>{{1, 3, 0}, {1, 3, -1}, {2, 3, 0}, {2, 3, -1}}));
}

TEST_F(ConvertPanels, LeavesSamplesOut)
{
    for (const int subframes : {1, 2}) {
        ASSERT_EQ(convert({"tee.abc", "b.abc", "--subframes", std::to_string(subframes)}).exit_code, 0);
        const PointCache cache = read_cache(file("b.abc"));
        EXPECT_EQ(cache.subframes(), subframes);
        EXPECT_EQ(cache.start_frame(), 5.0);
        ASSERT_EQ(cache.frame_count(), 2 * subframes + 1);
        for (int k = 0; k < cache.frame_count(); ++k)
            EXPECT_EQ(cache.frame(k)[0].y(), k * 4 / subframes);
    }
}

TEST_F(ConvertPanels, RefusesWhatACacheAloneCannotGive)
{
    expect_refused({"tee.abc", "b.abc", "--avatars"}, "--avatars: a cache has no avatars");
    expect_refused({"tee.abc", "b.abc", "--subframes", "3"},
                   "--subframes 3: tee.abc has 4 samples a frame; give a divisor of that");
    expect_refused({"tee.abc", "b.abc", "--thickness", "0"}, "--thickness 0: is no thickness of cloth");
    expect_refused({"tee.abc", "b.pc2", "--no-weld"}, "--no-weld: b.pc2 holds one mesh");
    ASSERT_EQ(convert({"tee.abc", "b.pc2"}).exit_code, 0);
    expect_refused({"b.pc2", "c.pc2", "--thickness", "0.01"}, "--thickness: c.pc2 stores no faces");
    expect_refused({"b.pc2", "c.obj", "--thickness", "0.01"}, "--thickness: b.pc2 has no faces");
}

TEST_F(ConvertTest, SaysHowManyShapesAGltfHasAndTheirError)
{
    write("a.abc");
    const Finished run = convert({"a.abc", "a.glb"});
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_THAT(run.output, testing::StartsWith("a.glb: 1 shape, largest error "));
    EXPECT_THAT(convert({"a.abc", "b.glb", "--max-error", "10"}).output,
                HasSubstr("0 shapes, largest error 2e+03 mm"));
    expect_refused({"a.abc", "c.glb", "--max-error", "0"}, "c.glb: largest error is 0");
    expect_refused({"a.glb", "c.pc2"}, "a.glb: is written for other programs");
}

/// What a certificate says is of the cache that it was made for.
TEST_F(ConvertTest, RemovesCertificatesOfWhatItReplaces)
{
    write("a.abc");
    write("a.pc2");
    temporary_.write("certificate.json", "{}");
    EXPECT_EQ(convert({"a.pc2", "new.pc2"}).exit_code, 0);
    EXPECT_TRUE(std::filesystem::exists(file("certificate.json")));
    EXPECT_EQ(convert({"a.abc", "a.pc2"}).exit_code, 0);
    EXPECT_FALSE(std::filesystem::exists(file("certificate.json")));
}

} // namespace

} // namespace toile::test
