#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/mesh/obj.h"
#include "core/mesh/triangle_mesh.h"
#include "tests/core/mesh/meshes.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

namespace {

using test::message_of;

/// OBJ file of the given text, removed at the end of the test.
class ObjFile {
public:
    explicit ObjFile(const std::string& text = {}) : path_(process_folder() / "mesh.obj")
    {
        std::ofstream(path_, std::ios::binary) << text;
    }
    ~ObjFile() { std::filesystem::remove(path_); }
    ObjFile(const ObjFile&) = delete;
    ObjFile& operator=(const ObjFile&) = delete;

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

using Polygons = std::vector<std::vector<int>>;

ObjMesh read_text(const std::string& text) { return read_obj(ObjFile(text).path()); }

/// Refusal of a file of this text, after its "path:".
std::string refusal(const std::string& text)
{
    const ObjFile file(text);
    const std::string message = message_of([&] { read_obj(file.path()); });
    const std::string prefix = file.path().string() + ":";
    return message.compare(0, prefix.size(), prefix) == 0 ? message.substr(prefix.size())
                                                          : "no place: " + message;
}

const std::string kThreeVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

} // namespace

TEST(ReadObj, NamesTheFirstFaceWithoutTexture)
{
    const std::string texture = "vt 0 0\nvt 1 0\nvt 0 1\n";
    EXPECT_EQ(read_text(kThreeVertices + texture + "f 1/1 2/2 3/3\n").first_plain_line, 0);
    EXPECT_EQ(read_text(kThreeVertices + texture + "f 1 2 3\n").first_plain_line, 0);
    const ObjMesh mixed = read_text(kThreeVertices + texture + "f 1/1 2/2 3/3\nf 1 2 3\nf 3 2 1\n");
    EXPECT_EQ(mixed.first_plain_line, 8);
    EXPECT_TRUE(mixed.polygon_uvs.empty());
}

TEST(Texture, IsThatOfTheTriangles)
{
    const ObjMesh mesh = read_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 5 5\nvt 6 5\nvt 6 6\nvt 5 6\n"
                                   "f 1/4 2/3 3/2 4/1\n");
    const std::vector<FlatTriangle> triangles = texture_triangles(mesh);
    ASSERT_EQ(triangles.size(), 2u);
    EXPECT_EQ(triangles[0], (FlatTriangle{Vec2(5, 6), Vec2(6, 6), Vec2(6, 5)}));
    EXPECT_EQ(triangles[1], (FlatTriangle{Vec2(5, 6), Vec2(6, 5), Vec2(5, 5)}));
    EXPECT_EQ(signed_area(triangles[0]), -0.5);
    EXPECT_EQ(signed_area({Vec2(0, 0), Vec2(2, 0), Vec2(0, 3)}), 3.0);
}

/// Two triangles that share an edge, but not its texture.
TEST(Texture, IsSubdividedWithItsTriangles)
{
    const ObjMesh mesh =
        read_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 8 0\nvt 9 1\n"
                  "vt 8 1\nf 1/1 2/2 3/3\nf 1/4 3/5 4/6\n");
    const ObjMesh fine = subdivide(mesh, 2);
    const TriangleMesh expected = subdivide(mesh.triangulated(), 2);
    EXPECT_EQ(fine.positions, expected.positions);
    EXPECT_EQ(fine.triangulated().triangles, expected.triangles);
    const std::vector<FlatTriangle> texture = texture_triangles(fine);
    ASSERT_EQ(texture.size(), expected.triangles.size());
    for (size_t t = 0; t < texture.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const Vec3& p = fine.positions[fine.polygons[t][size_t(k)]];
            EXPECT_EQ(texture[t][size_t(k)], Vec2(p.x() + (t < 16 ? 0.0 : 8.0), p.y()));
        }
    EXPECT_TRUE(subdivide(faces_of(mesh.triangulated()), 1).polygon_uvs.empty());
}

TEST(ReadObj, KeepsOrderQuadsAndTexture)
{
    const ObjMesh mesh = read_text("# a quad and a triangle\n"
                                   "o thing\n"
                                   "v 3 0 0\nv 2 0.5 0 1.0\nv -1e-3 0 0\r\nv 0 4 0\nv 0 0 5\n"
                                   "vt 0 0.25\nvt 1 0 0\nvt 1 1\n"
                                   "vn 0 1 0\n"
                                   "\n"
                                   "f 1/1/1 2/2/1 3/3/1 4/1/1\n"
                                   "  f\t5/3 1/1 3/2 \r\n");
    ASSERT_EQ(mesh.positions.size(), 5u);
    EXPECT_EQ(mesh.positions[0], Vec3(3, 0, 0));
    EXPECT_EQ(mesh.positions[1], Vec3(2, 0.5, 0));
    EXPECT_EQ(mesh.positions[2], Vec3(-1e-3, 0, 0));
    ASSERT_EQ(mesh.texture_coordinates.size(), 3u);
    EXPECT_EQ(mesh.texture_coordinates[0], Vec2(0, 0.25));
    EXPECT_EQ(mesh.polygons, (Polygons{{0, 1, 2, 3}, {4, 0, 2}}));
    EXPECT_EQ(mesh.polygon_uvs, (Polygons{{0, 1, 2, 0}, {2, 0, 1}}));
    EXPECT_EQ(mesh.triangulated().triangles, (std::vector<Triangle>{{1, 2, 3}, {0, 1, 3}, {4, 0, 2}}));
}

TEST(ReadObj, CountsNegativeIndicesFromTheLineTheyStandOn)
{
    const ObjMesh mesh =
        read_text(kThreeVertices + "vt 0 0\nf -3/-1 -2/-1 -1/-1\nv 9 9 9\nf -4/1 -2/1 -1/1\n");
    EXPECT_EQ(mesh.polygons, (Polygons{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(mesh.polygon_uvs, (Polygons{{0, 0, 0}, {0, 0, 0}}));
}

TEST(ReadObj, DropsTextureThatSomeFacesLack)
{
    const ObjMesh mesh = read_text(kThreeVertices + "vt 0 0\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\n");
    EXPECT_EQ(mesh.polygons.size(), 2u);
    EXPECT_TRUE(mesh.polygon_uvs.empty());
}

TEST(ReadObj, KeepsColoursThatAllVerticesHave)
{
    const ObjMesh mesh = read_text("v 0 0 0 1 0 0.5\nv 1 0 0 0 0.25 1\nv 0 1 0 0 0 0 9\nf 1 2 3\n");
    EXPECT_EQ(mesh.colours, (std::vector<Vec3>{Vec3(1, 0, 0.5), Vec3(0, 0.25, 1), Vec3::Zero()}));
    EXPECT_EQ(mesh.first_plain_vertex_line, 0);

    const ObjMesh mixed = read_text("v 0 0 0 1 0 0\nv 1 0 0 1.0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_TRUE(mixed.colours.empty());
    EXPECT_EQ(mixed.first_plain_vertex_line, 2);

    const ObjMesh plain = read_text(kThreeVertices + "f 1 2 3\n");
    EXPECT_TRUE(plain.colours.empty());
    EXPECT_EQ(plain.first_plain_vertex_line, 0);
}

TEST(Colours, AreSubdividedWithTheirVertices)
{
    ObjMesh mesh = read_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    mesh.colours = mesh.positions;
    const ObjMesh fine = subdivide(mesh, 2);
    EXPECT_EQ(fine.colours, fine.positions);
    EXPECT_TRUE(subdivide(faces_of(mesh.triangulated()), 1).colours.empty());
}

TEST(ReadObj, NamesTheLineOfEachMistake)
{
    const std::string number = "' is not a finite number; write a decimal number: -0.25, 3e-4";
    for (const char* word : {"x", "1,5", "nan", "inf", "1e999", "0x1p-1", "6.0D-01", "1.#QNAN", "+-1", "+"})
        EXPECT_EQ(refusal("v 0 0 0\nv 0 0 " + std::string(word) + "\n"), "2: '" + (word + number));
    EXPECT_EQ(refusal("v 0 0 0\nv 0 0 0 1 red 0\n"), "2: 'red" + number);
    EXPECT_EQ(refusal("v 0 0 0\nv 0 0 0 1 0 nan\n"), "2: 'nan" + number);
    const std::string ends =
        ": the line ends too soon; a vertex has x, y and z, a texture coordinate u and v";
    EXPECT_EQ(refusal("\nv 0 0\n"), "2" + ends);
    EXPECT_EQ(refusal("vt\n"), "1" + ends);

    const std::string& v = kThreeVertices;
    const std::string defined = " is out of range; 3 are defined above this line, numbered from 1";
    for (const char* index : {"4", "0", "-4", "99999999999", "-9223372036854775808"})
        EXPECT_EQ(refusal(v + "f 1 2 " + index + "\n"), std::string("4: vertex index ") + index + defined);
    const std::string corner = "is no vertex index; a corner is v, v/vt, v//vn or v/vt/vn in whole numbers";
    for (const char* word : {"2.5", "2,", "x", "/"})
        EXPECT_EQ(refusal(v + "f 1 2 " + word + "\n"),
                  "4: '" + std::string(word == std::string("/") ? "" : word) + "' " + corner);
    EXPECT_EQ(refusal(v + "f 1/1 2/1 3/1\n"),
              "4: texture index 1 is out of range; 0 are defined above this line, numbered from 1");
    EXPECT_EQ(refusal(v + "f 1\n"), "4: the face has 1 corner; it needs at least 3 and at most 10000");
    EXPECT_EQ(refusal(v + "f 1 2\n"), "4: the face has 2 corners; it needs at least 3 and at most 10000");
    EXPECT_EQ(refusal(v + "f\n"), "4: the face has 0 corners; it needs at least 3 and at most 10000");
    EXPECT_EQ(refusal(v + "vt 0 0\nf 1/1 2 3/1\n"),
              "5: some corners of the face have a texture index and some have none; give all or none");
}

/// Lines as Maya, classic Macs and Windows editors write them.
TEST(ReadObj, ReadsAnyLineEndsContinuationsAndAByteOrderMark)
{
    const ObjMesh plain = read_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\nf 1 2 3\n");
    const std::vector<std::string> texts{
        "\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\nf 1 2 3",
        "v 0 0 0\rv 1 0 0\rv 0 1 0\rl 1 2\rf 1 2 3\r",
        "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nl 1 \\\r\n2\r\nf 1 2 3\r\n",
        "v 0 \\\n0 \\\n0\nv 1 0 0\nv 0 1 0\nl 1 2\nf 1 2\\\n3\\",
    };
    for (const std::string& text : texts) {
        const ObjMesh mesh = read_text(text);
        EXPECT_EQ(mesh.positions, plain.positions) << text;
        EXPECT_EQ(mesh.polygons, plain.polygons) << text;
        EXPECT_EQ(mesh.lines, plain.lines) << text;
    }
    EXPECT_EQ(plain.lines, (std::vector<std::array<int, 2>>{{0, 1}}));
    EXPECT_EQ(plain.polygon_lines, std::vector<int>{5});
    EXPECT_EQ(read_text(texts[3]).polygon_lines, std::vector<int>{7});
    EXPECT_EQ(refusal("v 0 0\\\n 0\nv 1 x 0\n").substr(0, 2), "3:");
}

/// Numbers as other programs write them, and what else a line may have.
TEST(ReadObj, ReadsTheDialectsOfOtherPrograms)
{
    const ObjMesh plain = read_text(kThreeVertices + "vt 0.5 0\nf 1/1 2/1 3/1\n");
    const std::vector<std::string> texts{
        "v +0.0 0 1e-400\nv +1.0e+00 0 0\nv 0. 1. -0\nvt 0.5 0\nf +1/1 2/1 3/1\n",
        "# C:\\models\\\nv 0 0 0 # first\nv 1 0 0\t# second\nv 0 1 0\nvt .5\nf 1/1 2/1 3/1 # face\n",
        "#MRGB ff\nv 0 0 0 0.1 0.2 0.3\nv 1 0 0 1.0\nv 0 1 0 x\nvt 0.5 0 0\nfo 1/1/9 2/1/9 3/1/9\n",
        "mg 0\nlod 1\ns off\ng a b\nusemtl \"my cloth\"\n" + kThreeVertices + "vt 0.5\nf 1/1 2/1 3/1\np 1\n",
    };
    for (const std::string& text : texts) {
        const ObjMesh mesh = read_text(text);
        EXPECT_EQ(mesh.positions, plain.positions) << text;
        EXPECT_EQ(mesh.texture_coordinates, plain.texture_coordinates) << text;
        EXPECT_EQ(mesh.polygons, plain.polygons) << text;
        EXPECT_EQ(mesh.polygon_uvs, plain.polygon_uvs) << text;
    }
    EXPECT_EQ(read_text(kThreeVertices + "cstype bezier\nsurf 0 1 0 1 1 2 3\ncurv 0 1 1 2\nend\n")
                  .free_form_elements,
              2);
}

TEST(ReadObj, NamesOtherKindsOfFiles)
{
    const std::string utf16("\xff\xfev\0 \0", 6), binary("\x1f\x8b\x08\0\0", 5);
    for (const std::string& text : {utf16, binary})
        EXPECT_NE(refusal(text).find("is no OBJ: it is binary or in UTF-16"), std::string::npos);
    for (const char* text :
         {"", "ply\nformat ascii 1.0\n", "solid a\nfacet normal 0 0 1\n", "<html>", "V 0 0 0\n"})
        EXPECT_NE(refusal(text).find("is no OBJ: no line begins with v"), std::string::npos) << text;
}

TEST(ReadObj, NamesTheLineOfAnUnusableFace)
{
    ObjMesh mesh = read_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\n\nf 1 2 4\n");
    EXPECT_EQ(message_of([&] { require_usable(mesh, "a.obj"); }).substr(0, 28),
              "a.obj:7: the face has no are");
    mesh = read_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 2\n");
    EXPECT_EQ(message_of([&] { require_usable(mesh, "a.obj"); }).substr(0, 31),
              "a.obj:4: the face has a triangl");
    std::string wide = kThreeVertices + "f";
    for (int k = 0; k < 10001; ++k)
        wide += " 1";
    EXPECT_NE(refusal(wide).find("at most 10000"), std::string::npos);
}

TEST(ReadObj, NamesAFileThatIsMissingOrAFolder)
{
    EXPECT_EQ(message_of([] { read_obj("no/such.obj"); }),
              "no/such.obj: can't be opened; check the path and its permissions");
    EXPECT_EQ(message_of([] { read_obj("/"); }), "/: can't be read; give a file, not a folder");
}

TEST(WriteObj, RoundTripKeepsOrderQuadsAndTexture)
{
    ObjMesh mesh;
    mesh.positions = {{1.0 / 3.0, -2e-7, 123456.789}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}, {2, 2, 2}};
    mesh.texture_coordinates = {{0.125, 0.5}, {1, 0}};
    mesh.polygons = {{3, 2, 1, 0}, {4, 0, 2}};
    mesh.polygon_uvs = {{0, 1, 0, 1}, {1, 1, 0}};
    const ObjFile file;
    write_obj(file.path(), mesh);
    const ObjMesh again = read_obj(file.path());

    ASSERT_EQ(again.positions.size(), mesh.positions.size());
    for (size_t i = 0; i < mesh.positions.size(); ++i)
        EXPECT_LE((again.positions[i] - mesh.positions[i]).norm(), 5e-9 * mesh.positions[i].norm());
    EXPECT_EQ(again.texture_coordinates, mesh.texture_coordinates);
    EXPECT_EQ(again.polygons, mesh.polygons);
    EXPECT_EQ(again.polygon_uvs, mesh.polygon_uvs);
}

TEST(WriteObj, RoundTripKeepsColours)
{
    const ObjMesh mesh = read_text("v 0 0 0 1 0 0.5\nv 1 0 0 0 0.25 1\nv 0 1 0 0 0 0\nf 1 2 3\n");
    const ObjFile file;
    write_obj(file.path(), mesh);
    EXPECT_EQ(read_obj(file.path()).colours, mesh.colours);
    EXPECT_EQ(read_obj(file.path()).positions, mesh.positions);
}

TEST(WriteObj, OfTrianglesReadsBackAsTheSameTriangles)
{
    const TriangleMesh mesh = subdivide(test::tetrahedron(), 2);
    const ObjFile file;
    write_obj(file.path(), mesh);
    const TriangleMesh again = read_obj(file.path()).triangulated();
    EXPECT_EQ(again.positions, mesh.positions); // multiples of 1/4 are exact in nine digits
    EXPECT_EQ(again.triangles, mesh.triangles);
}

using Groups = std::vector<ObjGroup>;

TEST(ReadObj, KeepsGroupsByTheirFirstFaces)
{
    const std::string face = "f 1 2 3\n";
    const auto groups = [&](const std::string& text) { return read_text(kThreeVertices + text).groups; };
    EXPECT_EQ(groups(face), Groups{});
    EXPECT_EQ(groups("g front\n" + face + face + "g left  sleeve \r\n" + face),
              (Groups{{0, "front"}, {2, "left  sleeve"}}));
    // Faces before the first g, one without a name, groups without a face, and one that goes on.
    EXPECT_EQ(groups(face + "g none\ng a\n" + face + "g a\n" + face + "g\n" + face + "g end\n"),
              (Groups{{1, "a"}, {3, ""}}));
    EXPECT_EQ(groups("g a\n" + face + "g b\ng a\n" + face), (Groups{{0, "a"}}));
    EXPECT_EQ(groups("g a # not b\n" + face + "g c\\\nd\n" + face), (Groups{{0, "a"}, {1, "c d"}}));
}

TEST(WriteObj, RoundTripKeepsGroupsAndLines)
{
    ObjMesh mesh = faces_of(tetrahedron());
    mesh.groups = {{1, "front panel"}, {2, ""}, {3, "\xc3\xa4rmel"}};
    mesh.lines = {{0, 3}, {2, 1}};
    const ObjFile file;
    write_obj(file.path(), mesh);
    const ObjMesh again = read_obj(file.path());
    EXPECT_EQ(again.groups, mesh.groups);
    EXPECT_EQ(again.lines, mesh.lines);
    EXPECT_EQ(again.polygons, mesh.polygons);
}

TEST(WriteObj, LetsNoNameEndItsLine)
{
    ObjMesh mesh = faces_of(tetrahedron());
    mesh.groups = {{0, "a\nf 1 2 9"}, {1, "b #c"}, {2, "d\\"}};
    const ObjFile file;
    write_obj(file.path(), mesh);
    const ObjMesh again = read_obj(file.path());
    EXPECT_EQ(again.groups, (Groups{{0, "a_f 1 2 9"}, {1, "b _c"}, {2, "d_"}}));
    EXPECT_EQ(again.polygons, mesh.polygons);
}

TEST(ReadObj, ReadsTheRealGarmentsAndBodies)
{
    struct Known {
        const char* name;
        int vertices, triangles;
    };
    for (const Known& known :
         {Known{"cloth/cipc_tablecloth.obj", 14161, 27848}, Known{"cloth/cipc_skirt32x128.obj", 4096, 7936},
          Known{"colliders/cipc_bowl.obj", 1196, 2330}, Known{"bodies/smpl_f_template.obj", 6890, 13776}}) {
        const auto mesh = test::real_mesh(known.name);
        if (!mesh)
            GTEST_SKIP() << "SKIPPED: TOILE_DATA_DIR has no " << known.name;
        EXPECT_EQ(mesh->vertex_count(), known.vertices) << known.name;
        EXPECT_EQ(mesh->triangle_count(), known.triangles) << known.name;
        EXPECT_NO_THROW(require_usable(*mesh, known.name));
    }
}

TEST(ReadObj, KeepsTextureOfTheRealCow)
{
    const std::filesystem::path file =
        std::filesystem::path(TOILE_DATA_DIR) / "colliders/spot_triangulated.obj";
    if (!std::filesystem::exists(file))
        GTEST_SKIP() << "SKIPPED: TOILE_DATA_DIR has no colliders/spot_triangulated.obj";
    const ObjMesh mesh = read_obj(file);
    EXPECT_EQ(mesh.texture_coordinates.size(), 3225u);
    EXPECT_EQ(mesh.polygon_uvs.size(), 5856u);
    EXPECT_EQ(mesh.positions[0], Vec3(0.348799, -0.334989, -0.0832331)) << "first line stays first";
}

} // namespace toile::test
