#include "export/ply/ply_file.h"

#include <algorithm>

#include <gmock/gmock.h>

#include "tests/export/export_fixtures.h"
#include "tests/support/refusal.h"

namespace toile::test {

using namespace exports;

namespace {

using testing::HasSubstr;

class PlyTest : public ExportTest {
protected:
    ObjMesh read(const std::string& text) const
    {
        write_bytes(file("a.ply"), text);
        return read_ply(file("a.ply"));
    }
    std::string refusal_of(const std::string& text) const
    {
        return refusal([&] { read(text); });
    }
};

const std::string kFloats = "property float x\nproperty float y\nproperty float z\n";
const std::string kFaces = "property list uchar int vertex_indices\n";

TEST_F(PlyTest, WritesByteForByte)
{
    ObjMesh mesh;
    mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, -2, 0.5)};
    mesh.polygons = {{0, 1, 2}};
    const auto writer = make_cache_writer(file("a.ply"), cache_layout(mesh, 1));
    writer->write(0, mesh.positions);
    writer->finish();
    const char values[] = "\0\0\0\0\0\0\0\0\0\0\0\0"
                          "\0\0\x80\x3f\0\0\0\0\0\0\0\0"
                          "\0\0\0\0\0\0\0\xc0\0\0\0\x3f"
                          "\x03\0\0\0\0\x01\0\0\0\x02\0\0\0";
    EXPECT_EQ(bytes_of(file("a.ply")),
              "ply\nformat binary_little_endian 1.0\ncomment toile, unit m, up y\nelement vertex 3\n" +
                  kFloats + "element face 1\n" + kFaces + "end_header\n" +
                  std::string(values, sizeof values - 1));
}

TEST_F(PlyTest, KeepsPolygonsAndTextureCoordinatesOfCornersInEveryFrame)
{
    CacheLayout layout = cache_layout(quad_mesh(), 12);
    layout.start_frame = 95.0;
    const auto writer = make_cache_writer(file("skirt.ply"), layout);
    write_frames(*writer, 0, 12, 7);
    writer->finish();
    EXPECT_FALSE(std::filesystem::exists(file("skirt.partial")));
    const PointCache cache = read_cache(file("skirt_####.ply"));
    ASSERT_EQ(cache.frame_count(), 12);
    EXPECT_EQ(cache.start_frame(), 95.0);
    for (int frame = 0; frame < 12; ++frame)
        EXPECT_EQ(cache.frame(frame), frame_positions(frame, 7));
    const ObjMesh expected = quad_mesh();
    EXPECT_EQ(cache.mesh()->polygons, expected.polygons);
    for (size_t p = 0; p < expected.polygons.size(); ++p)
        for (size_t k = 0; k < expected.polygons[p].size(); ++k)
            EXPECT_EQ(cache.mesh()->texture_coordinates[size_t(cache.mesh()->polygon_uvs[p][k])],
                      expected.texture_coordinates[size_t(expected.polygon_uvs[p][k])]);
}

TEST_F(PlyTest, WritesPolygonsOfManyCorners)
{
    ObjMesh mesh;
    std::vector<int> corners;
    for (int v = 0; v < 300; ++v) {
        mesh.positions.push_back(Vec3(v, v % 2, 0));
        corners.push_back(v);
    }
    mesh.polygons = {corners};
    const auto writer = make_cache_writer(file("a.ply"), cache_layout(mesh, 1));
    writer->write(0, mesh.positions);
    writer->finish();
    EXPECT_EQ(read_ply(file("a.ply")).polygons, mesh.polygons);
}

/// A file with all that may be in it: other line ends, comments, properties, elements and lists.
TEST_F(PlyTest, ReadsTextOfOtherPrograms)
{
    const ObjMesh mesh =
        read("ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nobj_info nothing\r\n"
             "element camera 1\r\nproperty float view\r\nproperty list int float lens\r\n"
             "element vertex 3\r\nproperty double x\r\nproperty float nx\r\nproperty float y\r\n"
             "property float z\r\nproperty uchar red\r\nproperty float s\r\nproperty float t\r\n"
             "element face 1\r\nproperty uchar flags\r\nproperty list uchar uint vertex_index\r\n"
             "end_header\r\n"
             "7 2 1.5 2.5\r\n0 1 +0 0 255 0.25 0.75\r\n1e0 0 0 0 0 0 0\r\n0 0 1 0.5 9 1 1\r\n"
             "1 3 0 1 2\r\n");
    EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5}}));
    EXPECT_EQ(mesh.polygons, (std::vector<std::vector<int>>{{0, 1, 2}}));
    EXPECT_EQ(mesh.texture_coordinates[0], Vec2(0.25, 0.75));
    EXPECT_EQ(mesh.polygon_uvs, mesh.polygons);
}

TEST_F(PlyTest, ReadsNumbersOfAnySizeAndSkipsWhatItDoesNotUse)
{
    const std::vector<Vec3> expected{{0, 1e300, -2}, {1, 1, 1}, {2, 2, 2}};
    EXPECT_EQ(read("ply\nformat ascii 1.0\nelement vertex 3\n" + kFloats +
                   "property float quality\nend_header\n1e-400 1e300 -2 nan\n1 1 1 -inf\n2 2 2 1e400\n")
                  .positions,
              expected);
}

/// What a cache was written in, it is read in.
TEST_F(PlyTest, SaysItsUnitAndUpwardAxis)
{
    CacheLayout layout = cache_layout(quad_mesh(), 2);
    layout.axes = {"cm", "z"};
    const auto writer = make_cache_writer(file("skirt.ply"), layout);
    write_frames(*writer, 0, 2, 7);
    writer->finish();
    EXPECT_EQ(read_cache(file("skirt_####.ply")).axes(), layout.axes);
    EXPECT_EQ(read_cache(file("skirt_0001.ply")).axes(), layout.axes);

    const std::string text = bytes_of(file("skirt_0001.ply"));
    const std::string comment = "comment toile, unit cm, up z";
    for (const char* other : {"comment toile, unit ft, up z", "comment unit cm, up z"}) {
        write_bytes(file("other.ply"), std::string(text).replace(text.find(comment), comment.size(), other));
        EXPECT_EQ(read_cache(file("other.ply")).axes(), std::nullopt) << other;
    }
}

/// samples/make_samples.py, which wrote the files with these programs, says what is in them. Blender splits
/// vertices at seams of the texture.
TEST_F(PlyTest, ReadsFilesOfBlenderAndMeshLab)
{
    const std::filesystem::path samples =
        std::filesystem::path(TOILE_SOURCE_DIR) / "tests/export/ply/samples";
    for (const char* name : {"blender.ply", "blender_text.ply"}) {
        const ObjMesh mesh = read_ply(samples / name);
        EXPECT_EQ(mesh.positions,
                  (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0}, {1, 0, 0}, {2, 0.5, 1}}));
        EXPECT_EQ(mesh.polygons, (std::vector<std::vector<int>>{{0, 1, 2, 3}, {4, 5, 2}}));
        EXPECT_EQ(mesh.texture_coordinates[5], Vec2(0.5, 0));
    }
    const ObjMesh mesh = read_ply(samples / "meshlab.ply");
    EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0}, {2, 0.5, 1}}));
    ASSERT_EQ(mesh.polygons.size(), 3u);
    EXPECT_EQ(mesh.polygons[2], (std::vector<int>{1, 4, 2}));
    EXPECT_EQ(mesh.texture_coordinates[size_t(mesh.polygon_uvs[2][0])], Vec2(0, 0)); // (1, 0) in the quad
}

TEST_F(PlyTest, ReadsBothByteOrders)
{
    const ObjMesh mesh = quad_mesh();
    const auto writer = make_cache_writer(file("little.ply"), cache_layout(mesh, 1));
    writer->write(0, mesh.positions);
    writer->finish();
    std::string bytes = bytes_of(file("little.ply"));
    const size_t values = bytes.find("end_header\n") + 11;
    const auto swap = [&](size_t at) {
        std::reverse(bytes.begin() + long(at), bytes.begin() + long(at) + 4);
    };
    size_t at = values;
    for (int k = 0; k < 21; ++k, at += 4)
        swap(at);
    for (const size_t corners : {4, 4, 3}) {
        at += 1;
        for (size_t k = 0; k < corners; ++k, at += 4)
            swap(at);
        at += 1;
        for (size_t k = 0; k < 2 * corners; ++k, at += 4)
            swap(at);
    }
    ASSERT_EQ(at, bytes.size());
    bytes.replace(bytes.find("little"), 6, "big");
    write_bytes(file("big.ply"), bytes);
    EXPECT_EQ(read_ply(file("big.ply")).positions, mesh.positions);
    EXPECT_EQ(read_ply(file("big.ply")).polygons, mesh.polygons);
    EXPECT_EQ(read_ply(file("big.ply")).texture_coordinates,
              read_ply(file("little.ply")).texture_coordinates);
}

TEST_F(PlyTest, NamesThePlaceAndTheRemedyOfWhatIsWrong)
{
    const std::string start = "ply\nformat ascii 1.0\n";
    EXPECT_THAT(refusal_of("solid\n"), HasSubstr("a.ply:1: does not start with \"ply\""));
    EXPECT_THAT(refusal_of("ply\nformat ascii"), HasSubstr("a.ply:2: ends within the header"));
    EXPECT_THAT(refusal_of("ply\nformat text 1.0\n"), HasSubstr("known are ascii"));
    EXPECT_THAT(refusal_of(start + "element vertex -1\n"), HasSubstr("\"-1\" is no number of elements"));
    EXPECT_THAT(refusal_of(start + "element vertex 1\nproperty half x\n"),
                HasSubstr("a.ply:4: unknown type \"half\""));
    EXPECT_THAT(refusal_of(start + "element face 1\nproperty list float int vertex_indices\n"),
                HasSubstr("must be an integer"));
    EXPECT_THAT(refusal_of(start + "element vertex 2147483647\n" + kFloats + "end_header\n0 0 0\n"),
                HasSubstr("promises 2147483647 elements \"vertex\", for which the file is too short"));
    EXPECT_THAT(refusal_of(start + "element vertex 1\n" + kFloats + "end_header\n0 nan 0\n"),
                HasSubstr("no finite number"));
    EXPECT_THAT(refusal_of(start + "element vertex 1\n" + kFloats + "end_header\n0 0 z\n"),
                HasSubstr("no finite number"));
    EXPECT_THAT(refusal_of(start + "element vertex 1\nproperty float x\nend_header\n0\n"),
                HasSubstr("no x, y and z"));
    const std::string vertex =
        start + "element vertex 1\n" + kFloats + "element face 1\n" + kFaces + "end_header\n";
    EXPECT_THAT(refusal_of(vertex + "0 0 0\n3 0 0 1\n"),
                HasSubstr("a face uses vertex 1; there are vertices 0 to 0"));
    EXPECT_THAT(refusal_of(vertex + "0 0 0\n2 0 0\n"), HasSubstr("a face has 2 corners"));
    EXPECT_THAT(refusal_of(vertex + "0 0 0\n4000000000 0 0\n"), HasSubstr("can't have 4000000000"));
    EXPECT_THAT(refusal_of(vertex + "0 0 0\n"), HasSubstr("ends within its values"));
    write_bytes(file("a.ply"), start + "element vertex 1\n" + kFloats + "end_header\n0 0 0\n");
    EXPECT_THAT(refusal([&] { read_cache(file("a.ply")); }), HasSubstr("has no faces"));
}

} // namespace
} // namespace toile::test
