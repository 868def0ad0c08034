#include <cstdlib>

#include <gmock/gmock.h>

#include "export/usd/usd_python.h"
#include "tests/export/export_fixtures.h"
#include "tests/support/refusal.h"

namespace toile::test {

namespace {

using testing::HasSubstr;

/// What Pixar's library reads and writes; skipped without it.
class UsdCacheTest : public ExportTest {
protected:
    void SetUp() override
    {
        const std::string missing = refusal([] { require_usd_python("USD"); });
        if (!missing.empty())
            GTEST_SKIP() << missing;
    }

    static CacheLayout layout(int frames)
    {
        ObjMesh mesh = quad_mesh();
        mesh.groups = {{0, "front"}, {2, "back panel"}};
        CacheLayout layout = cache_layout(mesh, frames);
        layout.fps = 25.0;
        layout.start_frame = 1001.0;
        return layout;
    }

    void write(const std::string& name, const CacheLayout& layout) const
    {
        const auto writer = make_cache_writer(file(name), layout);
        write_frames(*writer, 0, layout.frame_count, layout.vertex_count());
        writer->finish();
    }

    static void expect_layout(const PointCache& cache, const CacheLayout& layout)
    {
        ASSERT_EQ(cache.frame_count(), layout.frame_count);
        EXPECT_EQ(*cache.fps(), layout.fps);
        EXPECT_EQ(cache.start_frame(), layout.start_frame);
        EXPECT_EQ(cache.subframes(), layout.subframes);
        EXPECT_EQ(*cache.axes(), layout.axes);
        for (int k = 0; k < layout.frame_count; ++k)
            EXPECT_EQ(cache.frame(k), frame_positions(k, 7)) << k;
        const ObjMesh& faces = layout.meshes[0].faces;
        EXPECT_EQ(cache.mesh()->polygons, faces.polygons);
        EXPECT_EQ(cache.mesh()->polygon_uvs, faces.polygon_uvs);
        EXPECT_EQ(cache.mesh()->texture_coordinates, faces.texture_coordinates);
        EXPECT_EQ(cache.mesh()->groups, faces.groups);
    }
};

std::filesystem::path sample(const std::string& name)
{
    return std::filesystem::path(TOILE_SOURCE_DIR "/tests/export/usd/samples") / name;
}

TEST_F(UsdCacheTest, ReadsBackWhatItWrites)
{
    for (const int frames : {10, 50, 51, 101, 120})
        for (const char* name : {"skirt.usda", "skirt.usdc"}) {
            SCOPED_TRACE(name + std::to_string(frames));
            write(name, layout(frames));
            expect_layout(read_cache(file(name)), layout(frames));
        }
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
        EXPECT_EQ(entry.path().string().find("partial"), std::string::npos) << entry.path();
}

TEST_F(UsdCacheTest, ReadsBackSubframesUnitsAndAxes)
{
    CacheLayout shot = layout(160);
    shot.subframes = 3;
    shot.start_frame = 1001.5;
    shot.axes = {"cm", "z"};
    for (const char* name : {"skirt.usda", "skirt.usdc"}) {
        write(name, shot);
        expect_layout(read_cache(file(name)), shot);
    }
}

/// USD rounds where it interpolates between equal numbers.
TEST_F(UsdCacheTest, AClothAtRestHasTheSameBitsInAllItsFrames)
{
    for (const int frames : {40, 120})
        for (const char* name : {"skirt.usda", "skirt.usdc"}) {
            SCOPED_TRACE(name + std::to_string(frames));
            CacheLayout shot = layout(frames);
            shot.subframes = 2;
            const auto at = [&](int k) {
                return std::vector<Vec3>(7, Vec3(0.1f, 1.0f / 3.0f,
                                                 k < 0.3 * frames   ? -0.7f
                                                 : k < 0.6 * frames ? k
                                                                    : 0.7f));
            };
            const auto writer = make_cache_writer(file(name), shot);
            for (int k = 0; k < frames; ++k)
                writer->write(k, at(k));
            writer->finish();
            const PointCache cache = read_cache(file(name));
            ASSERT_EQ(cache.frame_count(), frames);
            for (int k = 0; k < frames; ++k)
                EXPECT_EQ(cache.frame(k), at(k)) << k;
        }
}

TEST_F(UsdCacheTest, WhatAKilledRunLeavesIsReadable)
{
    const auto writer = make_cache_writer(file("skirt.usda"), layout(300));
    write_frames(*writer, 0, 180, 7);
    // What is on the disk now is what a killed process leaves.
    const PointCache cache = read_cache(writer->partial());
    ASSERT_EQ(cache.frame_count(), 151);
    for (int k = 0; k < 151; ++k)
        EXPECT_EQ(cache.frame(k), frame_positions(k, 7)) << k;
}

TEST_F(UsdCacheTest, WhatARunLeavesThatEndsEarlyIsReadable)
{
    for (const int frames : {40, 300})
        for (const char* name : {"skirt.usda", "skirt.usdc"})
            for (const int written : {1, 30, 51, 180}) {
                if (written >= frames)
                    continue;
                SCOPED_TRACE(std::to_string(written) + " of " + std::to_string(frames));
                const auto writer = make_cache_writer(file(name), layout(frames));
                write_frames(*writer, 0, written, 7);
                writer->keep();
                const PointCache cache = read_cache(writer->partial());
                ASSERT_EQ(cache.frame_count(), written);
                for (int k = 0; k < written; ++k)
                    EXPECT_EQ(cache.frame(k), frame_positions(k, 7)) << k;
            }
}

TEST_F(UsdCacheTest, FindsEachOfSeveralMeshes)
{
    CacheLayout two = layout(60);
    const ObjMesh faces = two.meshes[0].faces;
    two.meshes = {{"skirt", "", 7, faces}, {"7 vest", "", 7, faces}};
    const auto writer = make_cache_writer(file("all.usda"), two);
    for (int k = 0; k < two.frame_count; ++k) {
        std::vector<Vec3> positions = frame_positions(k, 7);
        for (const Vec3& x : frame_positions(k + 100, 7))
            positions.push_back(x);
        writer->write(k, positions);
    }
    writer->finish();
    const std::string all = file("all.usda").string();
    EXPECT_EQ(meshes_of_cache(all), (std::vector<std::filesystem::path>{all + "#/all/skirt/skirtShape",
                                                                        all + "#/all/_7_vest/_7_vestShape"}));
    EXPECT_EQ(read_cache(all + "#/all/_7_vest/_7_vestShape").frame(59), frame_positions(159, 7));
    EXPECT_THAT(refusal([&] { read_cache(all); }),
                HasSubstr("name one behind #: /all/skirt/skirtShape, /all/_7_vest/_7_vestShape"));
    EXPECT_THAT(refusal([&] { read_cache(all + "#/vest"); }), HasSubstr("has no mesh /vest"));
}

/// samples/make_samples.py, which wrote the file with Pixar's library, says what is in it.
TEST_F(UsdCacheTest, ReadsStagesOfOthers)
{
    const PointCache cache = read_cache(sample("moving_quad.usda").string() + "#/outer/inner/cloth");
    ASSERT_EQ(cache.frame_count(), 7);
    EXPECT_EQ(cache.subframes(), 2);
    EXPECT_EQ(*cache.fps(), 30.0);
    EXPECT_EQ(cache.start_frame(), 10.0);
    EXPECT_EQ(*cache.axes(), (Axes{"m", "z"}));
    for (int half = 0; half < 7; ++half)
        for (int k = 0; k < 5; ++k) {
            const double frame = 10 + 0.5 * half; // the transform is interpolated
            EXPECT_LT((cache.frame(half)[k] - 0.001 * Vec3(frame - 2 * frame, 2 * k, 0)).norm(), 1e-15);
        }
    const ObjMesh& mesh = *cache.mesh();
    EXPECT_EQ(mesh.polygons, (std::vector<std::vector<int>>{{0, 1, 2, 3}, {0, 3, 4}}));
    EXPECT_EQ(mesh.polygon_uvs, mesh.polygons);
    EXPECT_EQ(mesh.texture_coordinates[3], Vec2(3, 1.5));
    EXPECT_EQ(mesh.groups, (std::vector<ObjGroup>{{1, "sharp tip"}}));
    EXPECT_EQ(read_cache(sample("moving_quad.usda").string() + "#/still").frame_count(), 7);
}

TEST_F(UsdCacheTest, ReadsStagesOfBlender)
{
    const PointCache cache = read_cache(sample("blender.usdc"));
    ASSERT_EQ(cache.frame_count(), 4);
    EXPECT_EQ(*cache.fps(), 24.0);
    EXPECT_EQ(cache.start_frame(), 1.0);
    EXPECT_EQ(*cache.axes(), (Axes{"m", "z"}));
    for (int k = 0; k < 4; ++k)
        EXPECT_EQ(cache.frame(k)[5], Vec3(2, 1, 1 + 0.25 * k)) << k;
    EXPECT_EQ(cache.mesh()->polygons, (std::vector<std::vector<int>>{{0, 1, 4, 3}, {1, 2, 5, 4}}));
    EXPECT_EQ(cache.mesh()->texture_coordinates[size_t(cache.mesh()->polygon_uvs[1][2])], Vec2(1, 1));
    EXPECT_EQ(cache.mesh()->groups, (std::vector<ObjGroup>{{0, "left"}, {1, "right"}}));
}

TEST_F(UsdCacheTest, RefusesWhatIsNoCache)
{
    const auto said = [&](const std::string& path) { return refusal([&] { read_cache(path); }); };
    const std::string changing = sample("changing.usda");
    EXPECT_THAT(said(changing + "#/changing"), HasSubstr("changes its faces or points at time code 2"));
    EXPECT_THAT(said(changing + "#/body/skin"), HasSubstr("is moved by a skeleton"));
    write_bytes(file("bad.usda"), "#usda 1.0\ndef Mesh \"a\" {");
    EXPECT_THAT(said(file("bad.usda")), HasSubstr("bad.usda: can't be opened as USD"));
    write_bytes(file("empty.usda"), "#usda 1.0\n");
    EXPECT_THAT(said(file("empty.usda")), HasSubstr("empty.usda: has no mesh"));
    EXPECT_THAT(said(file("none.usda")), HasSubstr("none.usda: can't be found"));
    EXPECT_THAT(refusal([&] { meshes_of_cache(file("bad.usda")); }), HasSubstr("can't be opened as USD"));
}

TEST_F(UsdCacheTest, LeavesNothingInTheFolderForTemporaryFiles)
{
    write("skirt.usda", layout(3));
    std::filesystem::create_directory(file("tmp"));
    const char* const before = std::getenv("TMPDIR");
    ::setenv("TMPDIR", file("tmp").c_str(), 1);
    {
        const PointCache cache = read_cache(file("skirt.usda"));
        EXPECT_TRUE(std::filesystem::is_empty(file("tmp")));
        EXPECT_EQ(cache.frame(2), frame_positions(2, 7));
    }
    refusal([&] { read_cache(file("skirt.usda#/x")); });
    EXPECT_TRUE(std::filesystem::is_empty(file("tmp")));
    before ? ::setenv("TMPDIR", before, 1) : ::unsetenv("TMPDIR");
}

/// Needs no USD.
TEST(UsdPython, IsAskedForInOneLineWhereItIsMissing)
{
    const char* const variable = std::getenv("TOILE_PYTHON");
    const std::string before = variable ? variable : "";
    for (const char* python : {"/nowhere/python", "false"}) {
        ::setenv("TOILE_PYTHON", python, 1);
        if (std::string(python) == "false")
            EXPECT_THROW(require_usd_python("a.usda"), DeviceError);
        else
            EXPECT_EQ(
                refusal([] { require_usd_python("a.usda"); }),
                "a.usda: needs Python with USD, and /nowhere/python can't be started; pip install usd-core, "
                "or name another interpreter in TOILE_PYTHON");
    }
    variable ? ::setenv("TOILE_PYTHON", before.c_str(), 1) : ::unsetenv("TOILE_PYTHON");
}

} // namespace

} // namespace toile::test
