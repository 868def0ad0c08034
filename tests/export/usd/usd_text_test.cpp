#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "core/base/error.h"
#include "core/base/number.h"
#include "export/usd/usd_file.h"
#include "export/usd/usd_files.h"
#include "tests/export/export_fixtures.h"
#include "tests/support/refusal.h"

namespace toile::test {

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class UsdTextTest : public ExportTest {
protected:
    static CacheLayout layout(int frames)
    {
        ObjMesh mesh = quad_mesh();
        mesh.groups = {{0, "front"}, {2, "back \"panel\""}};
        CacheLayout layout = cache_layout(mesh, frames);
        layout.fps = 25.0;
        layout.start_frame = 1001.0;
        return layout;
    }

    std::string written(const std::string& name, const CacheLayout& layout) const
    {
        const auto writer = make_cache_writer(file(name), layout);
        write_frames(*writer, 0, layout.frame_count, layout.vertex_count());
        writer->finish();
        return bytes_of(file(name));
    }

    /// Names of all files, sorted.
    std::vector<std::string> files() const
    {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_))
            if (entry.is_regular_file())
                names.push_back(entry.path().lexically_relative(folder_).string());
        std::sort(names.begin(), names.end());
        return names;
    }
};

int count_of(const std::string& text, const std::string& word)
{
    int count = 0;
    for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
        ++count;
    return count;
}

TEST_F(UsdTextTest, SaysWhatTheNumbersAre)
{
    CacheLayout shot = layout(3);
    shot.axes = {"cm", "z"};
    const std::string text = written("skirt.usda", shot);
    EXPECT_EQ(text.rfind("#usda 1.0\n", 0), 0u);
    for (const char* line :
         {"defaultPrim = \"skirt\"", "metersPerUnit = 0.01", "upAxis = \"Z\"", "startTimeCode = 1001",
          "endTimeCode = 1003", "timeCodesPerSecond = 25", "framesPerSecond = 25", "def Xform \"skirt\"",
          "def Mesh \"skirtShape\"", "int[] faceVertexCounts = [4, 4, 3]",
          "int[] faceVertexIndices = [0, 1, 4, 3, 1, 2, 5, 4, 3, 4, 6]",
          "primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0.5)] (interpolation = \"faceVarying\")",
          "int[] primvars:st:indices = [0, 1, 2, 3, 3, 2, 1, 0, 0, 4, 2]", "orientation = \"rightHanded\"",
          "subdivisionScheme = \"none\"", "def GeomSubset \"front\"", "int[] indices = [0, 1]",
          "displayName = \"back \\\"panel\\\"\"", "rel material:binding = </skirt/skirt/back__panel_>"})
        EXPECT_THAT(text, HasSubstr(line));
    EXPECT_THAT(text, HasSubstr("1002: [(1.5, 0.25, -100), (1.5, 1.25, -101)"));
    EXPECT_THAT(text, HasSubstr("vector3f[] velocities = [(25, 0, -2500), (25, 0, -2500)"));
    EXPECT_THAT(text, HasSubstr("1002: [(1.5, 0.25, -106), (1.5, 6.25, -100)]"));
    EXPECT_THAT(files(), ElementsAre("skirt.usda"));
}

TEST_F(UsdTextTest, HasVelocitiesAndNormalsIfTheLayoutSays)
{
    CacheLayout shot = layout(2);
    EXPECT_THAT(written("a.usda", shot), Not(HasSubstr("normal3f[]")));
    shot.velocities = false;
    shot.normals = true;
    const std::string text = written("b.usda", shot);
    EXPECT_THAT(text, Not(HasSubstr("velocities")));
    EXPECT_THAT(text, HasSubstr("normal3f[] normals = [(0, 0, 0), "));
    EXPECT_THAT(text, HasSubstr("(0, 0, 0)] (interpolation = \"faceVarying\")"));
}

TEST_F(UsdTextTest, FloatsReadBackWithTheSameBits)
{
    const std::vector<float> floats{0.1f, -0.0f, 16777216.0f, 1e-45f, 3.4028235e38f, 1.0f / 3.0f};
    UsdFile file(this->file("floats"));
    file.append(floats.data(), floats.size(), 3);
    file.commit();
    EXPECT_EQ(bytes_of(this->file("floats")), "[(0.1, -0, 16777216), (1e-45, 3.4028235e+38, 0.33333334)]");
    EXPECT_EQ(shortest_text(1001.0 + 1.0 / 3.0), "1001.3333333333334");
}

TEST_F(UsdTextTest, NamesInQuotesAreAlwaysText)
{
    EXPECT_EQ(usd_quoted("v\xc3\xa9lo \\ \"x\"\n"), "\"v\xc3\xa9lo \\\\ \\\"x\\\"_\"");
    EXPECT_EQ(usd_quoted("\xff\xe9t\xc3"), "\"__t_\"");
    EXPECT_EQ(usd_quoted("\xed\xa0\x80"), "\"___\""); // half of a pair of UTF-16
}

TEST_F(UsdTextTest, AFileAppearsWhenItIsWhole)
{
    {
        UsdFile file(this->file("a.usda"));
        file << "half";
        EXPECT_FALSE(std::filesystem::exists(this->file("a.usda")));
    }
    EXPECT_TRUE(files().empty());
}

TEST_F(UsdTextTest, MeshesLieInTheirGroupsBelowAPrimCalledAsTheFile)
{
    const ObjMesh faces = layout(1).meshes[0].faces;
    CacheLayout three;
    three.frame_count = 1;
    three.meshes = {{"skirt", "", 7, faces}, {"front", "tee", 7, faces}, {"7 back", "tee", 7, faces}};
    const std::string text = written("all.usda", three);
    EXPECT_THAT(text, HasSubstr("defaultPrim = \"all\""));
    EXPECT_LT(text.find("def Xform \"all\""), text.find("def Xform \"skirt\""));
    EXPECT_LT(text.find("def Xform \"tee\""), text.find("def Mesh \"frontShape\""));
    EXPECT_THAT(text, HasSubstr("def Xform \"_7_back\" (\n            displayName = \"7 back\""));
    EXPECT_THAT(text, HasSubstr("</all/tee/_7_back/front>"));
    three.meshes.erase(three.meshes.begin());
    const std::string panels = written("look.usda", three);
    EXPECT_THAT(panels, HasSubstr("defaultPrim = \"look\""));
    EXPECT_THAT(panels, HasSubstr("</look/tee/front/front>"));
    three.meshes[0].name = "7-back";
    EXPECT_THAT(refusal([&] { make_cache_writer(file("b.usda"), three); }),
                HasSubstr("two meshes would be called \"tee/_7_back\""));
}

TEST_F(UsdTextTest, AMaterialIsNotCalledAsTheMesh)
{
    CacheLayout shot = layout(1);
    shot.meshes[0].faces.groups = {{0, "aShape"}, {1, "aShape_"}};
    const std::string text = written("a.usda", shot);
    EXPECT_THAT(text, HasSubstr("def Material \"aShape__\""));
    EXPECT_EQ(count_of(text, "def Material"), 2);
}

TEST_F(UsdTextTest, EqualSamplesAtEitherEndAreLeftOut)
{
    CacheLayout shot = layout(6);
    shot.velocities = false;
    const auto writer = make_cache_writer(file("a.usda"), shot);
    for (int k = 0; k < 6; ++k)
        writer->write(k, frame_positions(std::clamp(k, 2, 3), 7));
    writer->finish();
    const std::string text = bytes_of(file("a.usda"));
    const std::string points = text.substr(text.find("points.timeSamples"));
    for (const char* time : {"1003: ", "1004: "})
        EXPECT_THAT(points, HasSubstr(time));
    for (const char* time : {"1001: ", "1002: ", "1005: ", "1006: "})
        EXPECT_THAT(points, Not(HasSubstr(time)));
    EXPECT_THAT(text, HasSubstr("endTimeCode = 1006"));
}

TEST_F(UsdTextTest, AStillMeshHasNoSamples)
{
    const std::string text = written("a.usda", layout(1));
    EXPECT_THAT(text, Not(HasSubstr("timeSamples")));
    EXPECT_THAT(text, HasSubstr("point3f[] points = [(0.5, 0.25, -0)"));
}

TEST_F(UsdTextTest, ALongCacheIsARootAndClips)
{
    const std::string root = written("skirt.usda", layout(120));
    EXPECT_THAT(files(),
                ElementsAre("skirt.usda", "skirt_clips/skirt.0000.usda", "skirt_clips/skirt.0001.usda",
                            "skirt_clips/skirt.0002.usda", "skirt_clips/skirt.manifest.usda"));
    for (const char* line :
         {"double2[] active = [(1001, 0), (1051, 1), (1101, 2)]",
          "asset[] assetPaths = [@./skirt_clips/skirt.0000.usda@, @./skirt_clips/skirt.0001.usda@, ",
          ", @./skirt_clips/skirt.0002.usda@]",
          "asset manifestAssetPath = @./skirt_clips/skirt.manifest.usda@", "string primPath = \"/skirt\"",
          "double2[] times = [(1001, 1001), (1120, 1120)]", "endTimeCode = 1120",
          "int[] faceVertexCounts = [4, 4, 3]", "point3f[] points\n"})
        EXPECT_THAT(root, HasSubstr(line));
    EXPECT_THAT(root, Not(HasSubstr("timeSamples")));
    const std::string clip = bytes_of(file("skirt_clips/skirt.0000.usda"));
    EXPECT_THAT(clip, HasSubstr("over \"skirtShape\""));
    EXPECT_THAT(clip, HasSubstr("1001: [(0.5, "));
    EXPECT_THAT(clip, HasSubstr("1051: [(50.5, ")); // to interpolate to
    EXPECT_THAT(clip, Not(HasSubstr("1052: ")));
    EXPECT_THAT(bytes_of(file("skirt_clips/skirt.manifest.usda")), HasSubstr("point3f[] points\n"));
}

TEST_F(UsdTextTest, TheLastClipHasMoreThanOneSample)
{
    EXPECT_EQ(usd_clip_count(50), 0);
    EXPECT_EQ(usd_clip_count(51), 1);
    EXPECT_EQ(usd_clip_count(52), 2);
    EXPECT_EQ(usd_clip_count(101), 2);
    for (const int frames : {51, 101, 102}) {
        const std::string root = written("skirt.usda", layout(frames));
        EXPECT_THAT(root, HasSubstr("endTimeCode = " + std::to_string(1000 + frames) + "\n"));
        EXPECT_EQ(count_of(root, "@./skirt_clips/skirt.0"), usd_clip_count(frames)) << frames;
    }
}

TEST_F(UsdTextTest, UntilItIsPublishedTheEarlierCacheStays)
{
    const std::string earlier = written("skirt.usda", layout(200));
    const std::string clip = bytes_of(file("skirt_clips/skirt.0000.usda"));
    CacheLayout later = layout(120);
    later.fps = 30.0;
    const auto writer = make_cache_writer(file("skirt.usda"), later);
    write_frames(*writer, 0, 120, 7);
    EXPECT_EQ(writer->complete(), file("skirt.partial/skirt.usda"));
    EXPECT_EQ(bytes_of(file("skirt.usda")), earlier);
    EXPECT_EQ(bytes_of(file("skirt_clips/skirt.0000.usda")), clip);
    EXPECT_EQ(files().size(), 6u + 5u);
    write_bytes(file("skirt_clips/notes.txt"), "mine");
    writer->publish();
    EXPECT_NE(bytes_of(file("skirt.usda")), earlier);
    EXPECT_THAT(files(), ElementsAre("skirt.usda", "skirt_clips/notes.txt", "skirt_clips/skirt.0000.usda",
                                     "skirt_clips/skirt.0001.usda", "skirt_clips/skirt.0002.usda",
                                     "skirt_clips/skirt.manifest.usda"));
    // A short one needs no clips.
    written("skirt.usda", layout(20));
    EXPECT_THAT(files(), ElementsAre("skirt.usda", "skirt_clips/notes.txt"));
}

TEST_F(UsdTextTest, AShortCacheLeavesNoFolderOfClips)
{
    written("skirt.usda", layout(200));
    written("skirt.usda", layout(20));
    EXPECT_FALSE(std::filesystem::exists(file("skirt_clips")));
}

TEST_F(UsdTextTest, SaysThatAnEarlierClipCannotBeRemoved)
{
    std::filesystem::create_directories(file("skirt_clips/skirt.0007.usda/full"));
    try {
        written("skirt.usda", layout(20));
        FAIL() << "removed a folder";
    } catch (const DeviceError& error) {
        EXPECT_THAT(error.what(), HasSubstr("skirt.0007.usda: is of an earlier cache and can't be removed"));
    }
    EXPECT_THAT(files(), ElementsAre("skirt.usda"));
}

TEST_F(UsdTextTest, APartialStaysUntilTheFirstFrame)
{
    {
        const auto killed = make_cache_writer(file("skirt.usda"), layout(120));
        write_frames(*killed, 0, 70, 7);
    }
    EXPECT_THAT(files(), ElementsAre("skirt.partial/skirt.usda", "skirt.partial/skirt_clips/skirt.0000.usda",
                                     "skirt.partial/skirt_clips/skirt.manifest.usda"));
    EXPECT_THAT(bytes_of(file("skirt.partial/skirt.usda")), HasSubstr("endTimeCode = 1051\n"));
    const auto writer = make_cache_writer(file("skirt.usda"), layout(120));
    EXPECT_EQ(files().size(), 3u);
    write_frames(*writer, 0, 1, 7);
    EXPECT_THAT(files(), ElementsAre("skirt.partial/skirt_clips/skirt.manifest.usda"));
}

TEST_F(UsdTextTest, ARunThatEndsEarlyKeepsAllItsSamples)
{
    for (const int frames : {40, 120})
        for (const int written : {1, 2, 39, 50, 51, 52, 101, 102, 119}) {
            if (written >= frames)
                continue;
            SCOPED_TRACE(std::to_string(written) + " of " + std::to_string(frames));
            const auto writer = make_cache_writer(file("skirt.usda"), layout(frames));
            EXPECT_EQ(writer->readable_samples(), 0);
            write_frames(*writer, 0, written, 7);
            EXPECT_EQ(writer->readable_samples(), written <= 51 ? 0 : written <= 101 ? 51 : 101);
            writer->keep();
            EXPECT_EQ(writer->readable_samples(), written);
            EXPECT_THAT(bytes_of(writer->partial()),
                        HasSubstr("endTimeCode = " + std::to_string(1000 + written) + "\n"));
            writer->keep();
            EXPECT_EQ(int(files().size()), frames == 40 ? 1 : 2 + std::max(1, usd_clip_count(written)));
            std::filesystem::remove_all(file("skirt.partial"));
            std::filesystem::remove(file("skirt.partial.usda"));
        }
}

TEST_F(UsdTextTest, RefusesWhatItCannotWrite)
{
    CacheLayout later = layout(4);
    later.resume_at = 2;
    const auto said = [&](const char* name, const CacheLayout& layout) {
        return refusal([&] { make_cache_writer(file(name), layout); });
    };
    EXPECT_THAT(said("skirt.usda", later), HasSubstr("can't be continued"));
    EXPECT_THAT(said("a@b.usda", layout(4)), HasSubstr("choose a name without @"));
    EXPECT_THAT(said("skirt.usd", layout(4)), HasSubstr("write .usda or .usdc"));
    EXPECT_THAT(said("skirt.usda#/skirt", layout(4)), HasSubstr("names a mesh in an archive"));
    CacheLayout points = layout(4);
    points.meshes[0].faces = {};
    EXPECT_THAT(said("skirt.usda", points), HasSubstr("needs faces"));
}

} // namespace

} // namespace toile::test
