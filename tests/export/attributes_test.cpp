#include <gmock/gmock.h>

#include "core/base/number.h"
#include "export/alembic/abc_reader.h"
#include "export/async_cache_writer.h"
#include "export/byte_order.h"
#include "export/ply/ply_file.h"
#include "tests/export/export_fixtures.h"
#include "tests/support/refusal.h"

namespace toile::test {

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class AttributesTest : public ExportTest {
protected:
    /// A skirt of seven vertices with strain and gap, whose first and last faces are one panel.
    static CacheLayout layout(int frames)
    {
        ObjMesh mesh = quad_mesh();
        mesh.groups = {{0, "front; a"}, {1, "back"}, {2, "front; a"}};
        CacheLayout layout = cache_layout(mesh, frames);
        layout.meshes[0].name = "skirt";
        layout.meshes[0].attributes = {"strain", "gap"};
        layout.meshes[0].panels = face_panels(mesh);
        layout.start_frame = 1.0;
        return layout;
    }

    /// The same between two bodies without attributes.
    static CacheLayout layout_with_bodies(int frames)
    {
        CacheLayout all = layout(frames);
        for (const char* name : {"left", "right"}) {
            CacheMesh body = cache_layout(quad_mesh(), 1).meshes[0];
            body.name = name;
            all.meshes.insert(name == std::string("left") ? all.meshes.begin() : all.meshes.end(), body);
        }
        return all;
    }

    /// Exact in single precision.
    static std::vector<float> strain(int frame) { return numbers(0.125f + float(frame), 0.0625f); }
    static std::vector<float> gap(int frame) { return numbers(-0.5f * float(frame), 0.25f); }
    static std::vector<float> numbers(float first, float step)
    {
        std::vector<float> numbers;
        for (int v = 0; v < 7; ++v)
            numbers.push_back(first + step * float(v));
        return numbers;
    }
    static CacheSample sample(int frame, int vertex_count)
    {
        CacheSample sample{frame_positions(frame, vertex_count), strain(frame)};
        const std::vector<float> second = gap(frame);
        sample.attributes.insert(sample.attributes.end(), second.begin(), second.end());
        return sample;
    }

    std::filesystem::path written(const std::string& name, const CacheLayout& layout) const
    {
        const auto writer = make_cache_writer(file(name), layout);
        for (int frame = 0; frame < layout.frame_count; ++frame)
            writer->write(frame, sample(frame, layout.vertex_count()));
        writer->finish();
        return file(name);
    }

    static std::string text_of(const std::vector<float>& numbers)
    {
        std::string text;
        for (const float number : numbers)
            text += (text.empty() ? "" : ", ") + shortest_text(number);
        return "[" + text + "]";
    }
};

TEST_F(AttributesTest, OfAlembicAreParametersOfTheirMeshOnly)
{
    const AbcReader reader(written("skirt.abc", layout_with_bodies(12)));
    int meshes = 0;
    for (size_t k = 0; k < reader.objects().size(); ++k) {
        const auto& properties = reader.objects()[k].properties;
        const auto of_vertex = reader.find(properties, {".geom", ".arbGeomParams", "strain"});
        EXPECT_EQ(of_vertex.has_value(), reader.path_of(int(k)) == "/skirt/skirtShape");
        if (!of_vertex)
            continue;
        ++meshes;
        EXPECT_EQ(of_vertex->samples, 12);
        EXPECT_THAT(of_vertex->metadata, HasSubstr("geoScope=vtx"));
        const auto distance = reader.find(properties, {".geom", ".arbGeomParams", "gap"});
        for (int frame = 0; frame < 12; ++frame) {
            EXPECT_EQ(values_of<float>(reader.sample(*of_vertex, frame)), strain(frame));
            EXPECT_EQ(values_of<float>(reader.sample(*distance, frame)), gap(frame));
        }
        const auto panel = reader.find(properties, {".geom", ".arbGeomParams", "panel"});
        EXPECT_THAT(panel->metadata, HasSubstr("geoScope=uni"));
        EXPECT_THAT(panel->metadata, HasSubstr("toile_names=front_ a,back"));
        EXPECT_THAT(values_of<std::int32_t>(reader.sample(*panel, 0)), ElementsAre(0, 1, 0));
    }
    EXPECT_EQ(meshes, 1);
    EXPECT_EQ(read_cache(file("skirt.abc#/right/rightShape")).frame(11)[6], frame_positions(11, 21)[20]);
}

TEST_F(AttributesTest, OfUsdArePrimvars)
{
    const std::string text = bytes_of(written("skirt.usda", layout_with_bodies(3)));
    for (const std::string& line :
         {std::string("float[] primvars:strain (interpolation = \"vertex\")"), "1: " + text_of(strain(0)),
          "3: " + text_of(strain(2)), "2: " + text_of(gap(1)),
          std::string("int[] primvars:panel = [0, 1, 0] ("), std::string("interpolation = \"uniform\""),
          std::string("string[] names = [\"front; a\", \"back\"]")})
        EXPECT_THAT(text, HasSubstr(line));
    EXPECT_EQ(text.find("primvars:strain.timeSamples"), text.rfind("primvars:strain.timeSamples"));
}

TEST_F(AttributesTest, OfUsdAreInItsClips)
{
    const std::string root = bytes_of(written("skirt.usda", layout(60)));
    EXPECT_THAT(root, HasSubstr("float[] primvars:strain (interpolation = \"vertex\")\n"));
    EXPECT_THAT(root, Not(HasSubstr("strain.timeSamples")));
    EXPECT_THAT(root, HasSubstr("primvars:panel = [0, 1, 0]"));
    EXPECT_THAT(bytes_of(file("skirt_clips/skirt.manifest.usda")), HasSubstr("float[] primvars:gap"));
    const std::string clip = bytes_of(file("skirt_clips/skirt.0001.usda"));
    EXPECT_THAT(clip, HasSubstr("float[] primvars:strain.timeSamples = {"));
    EXPECT_THAT(clip, HasSubstr("60: " + text_of(strain(59))));
    EXPECT_THAT(clip, Not(HasSubstr("panel")));
}

TEST_F(AttributesTest, OfPlyAreFurtherPropertiesThatReadersSkip)
{
    const std::filesystem::path ply = written("skirt.ply", layout(1));
    const std::string bytes = bytes_of(ply);
    EXPECT_THAT(bytes, HasSubstr("comment panel 0 front; a\ncomment panel 1 back\nelement vertex 7\n"));
    EXPECT_THAT(bytes, HasSubstr("property float z\nproperty float strain\nproperty float gap\nelement"));
    EXPECT_THAT(bytes, HasSubstr("float texcoord\nproperty int panel\nend_header\n"));
    const std::string vertices = bytes.substr(bytes.find("end_header\n") + 11, 7 * 20);
    const std::vector<float> numbers = values_of<float>(vertices);
    for (size_t v = 0; v < 7; ++v) {
        EXPECT_EQ(numbers[5 * v + 3], strain(0)[v]);
        EXPECT_EQ(numbers[5 * v + 4], gap(0)[v]);
    }
    EXPECT_EQ(take<std::int32_t>(&bytes[bytes.size() - 4]), 0);
    const ObjMesh read = read_ply(ply);
    EXPECT_EQ(read.positions, frame_positions(0, 7));
    EXPECT_EQ(read.polygons, quad_mesh().polygons);
    EXPECT_EQ(read.polygon_uvs, quad_mesh().polygon_uvs);
}

TEST_F(AttributesTest, OfVtkArePointAndCellData)
{
    for (const bool velocities : {true, false}) {
        CacheLayout shot = layout(2);
        shot.velocities = velocities;
        written("skirt.pvd", shot);
        const std::string vtu = bytes_of(file("skirt_0002.vtu"));
        EXPECT_THAT(vtu, HasSubstr(velocities ? "<PointData Vectors=\"velocity\">" : "<PointData>"));
        EXPECT_THAT(vtu, HasSubstr("<CellData>\n<DataArray type=\"Int32\" Name=\"panel\""));
        EXPECT_THAT(vtu,
                    HasSubstr("Name=\"panel_names\" NumberOfTuples=\"2\" format=\"ascii\">102 114 111 "));
        std::string stored;
        for (const float number : strain(1))
            append(stored, number);
        EXPECT_THAT(vtu, HasSubstr(stored));
    }
}

TEST_F(AttributesTest, WaitInTheQueueWithTheirFrame)
{
    const std::filesystem::path direct = written("direct.abc", layout(9));
    AsyncCacheWriter queued(make_cache_writer(file("queued.abc"), layout(9)), 2);
    for (int frame = 0; frame < 9; ++frame) {
        if (frame % 2 == 0)
            queued.write(frame, sample(frame, 7));
        else
            queued.write_later(frame, [frame] { return sample(frame, 7); });
    }
    queued.finish();
    EXPECT_EQ(bytes_of(file("queued.abc")), bytes_of(direct));
}

TEST_F(AttributesTest, AreRefusedWhereTheFormatHasNone)
{
    for (const char* name : {"a.pc2", "a.mdd", "a.obj", "a_###.obj", "a.glb"})
        EXPECT_THAT(refusal([&] { make_cache_writer(file(name), layout(3)); }),
                    HasSubstr("stores no attributes; write an .abc, .usda, .usdc, .ply or .pvd"))
            << name;
    CacheLayout only_panels = layout(3);
    only_panels.meshes[0].attributes.clear();
    EXPECT_THAT(refusal([&] { make_cache_writer(file("a.pc2"), only_panels); }), HasSubstr("no attributes"));
    EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(AttributesTest, AreRefusedUnderNamesThatAFormatCannotHold)
{
    for (const char* name : {"a b", "", "panel", "strain", "1st"}) {
        CacheLayout layout = AttributesTest::layout(1);
        layout.meshes[0].attributes[1] = name;
        EXPECT_THAT(refusal([&] { make_cache_writer(file("a.abc"), layout); }),
                    HasSubstr("has an attribute \"" + std::string(name) + "\"; give each a name of its own"));
    }
    CacheLayout layout = AttributesTest::layout(1);
    layout.meshes[0].panels.of_face.pop_back();
    EXPECT_THAT(refusal([&] { make_cache_writer(file("a.abc"), layout); }),
                HasSubstr("has panels of 2 faces"));
}

TEST_F(AttributesTest, AreOneForEachVertex)
{
    for (const char* name : {"a.abc", "a.usda", "a.ply", "a.pvd"}) {
        const auto writer = make_cache_writer(file(name), layout(2));
        EXPECT_THAT(refusal([&] { writer->write(0, frame_positions(0, 7)); }),
                    HasSubstr("frame 0 has 0 numbers of attributes and the cache 14"));
    }
}

TEST(FacePanels, NumberGroupsInTheOrderOfTheirFirstFace)
{
    ObjMesh mesh = quad_mesh();
    EXPECT_THAT(face_panels(mesh).of_face, ElementsAre(0, 0, 0));
    EXPECT_THAT(face_panels(mesh).names, ElementsAre("other"));
    mesh.groups = {{1, "b"}, {2, "a"}};
    EXPECT_THAT(face_panels(mesh).of_face, ElementsAre(0, 1, 2));
    EXPECT_THAT(face_panels(mesh).names, ElementsAre("other", "b", "a"));
    mesh.groups = {{0, "b"}, {0, "a"}, {2, "b"}};
    EXPECT_THAT(face_panels(mesh).of_face, ElementsAre(0, 0, 1));
    EXPECT_THAT(face_panels(mesh).names, ElementsAre("a", "b")) << "the first b has no face";
}

} // namespace
} // namespace toile::test
