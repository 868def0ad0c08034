#include "avatars/appearance/load_appearance.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

#include "avatars/load_avatar.h"
#include "core/base/error.h"
#include "tests/avatars/gltf_sample.h"

namespace toile::test {

using namespace avatars;
using testing::ElementsAre;
using testing::HasSubstr;

namespace {

const std::string kPrimitive = "/meshes/0/primitives/0";

Appearance appearance_of(const std::filesystem::path& file)
{
    AvatarSettings settings;
    settings.file = file;
    return load_appearance(file, load_avatar(settings)->triangles());
}

/// Texture coordinates that tell the vertex.
std::vector<float> numbered_coordinates(int count)
{
    std::vector<float> numbers;
    for (int v = 0; v < count; ++v)
        numbers.insert(numbers.end(), {0.125f * float(v), 0.5f});
    return numbers;
}

/// A triangle with a texture, embedded as three bytes that nothing here decodes.
GltfSample textured_triangle()
{
    GltfSample sample = GltfSample::triangle();
    sample.at(kPrimitive + "/attributes/TEXCOORD_0") = sample.add(numbered_coordinates(3), "VEC2");
    sample.at(kPrimitive + "/material") = 0;
    sample.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    sample.json["textures"] = {{{"source", 0}}};
    sample.json["images"] = {{{"uri", "data:image/png;base64,AAEC"}}};
    return sample;
}

} // namespace

TEST(Appearance, HasImagesAsStored)
{
    const Appearance appearance = appearance_of(textured_triangle().saved());
    ASSERT_EQ(appearance.images.size(), 1u);
    EXPECT_THAT(appearance.images[0].bytes, ElementsAre(0, 1, 2));
    EXPECT_THAT(appearance.images[0].place, HasSubstr(".gltf: images[0]"));
    EXPECT_THAT(appearance.material, ElementsAre(0));
    EXPECT_EQ(appearance.coordinates[0][2], Vec2(0.25, 0.5));
    EXPECT_EQ(appearance.materials[0].cutoff, 0.0);
    EXPECT_FALSE(appearance.materials[0].colour);
    EXPECT_TRUE(appearance.left_out.empty());
}

TEST(Appearance, KeepsCoordinatesOnBothSidesOfASeam)
{
    GltfSample sample = textured_triangle();
    // A square of two triangles that repeat the vertices of the diagonal, after one without area.
    sample.at(kPrimitive + "/attributes/POSITION") =
        sample.add<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
    sample.at(kPrimitive + "/attributes/TEXCOORD_0") = sample.add(numbered_coordinates(6), "VEC2");
    sample.at(kPrimitive + "/indices") = sample.add<std::uint16_t>({0, 3, 1, 0, 1, 2, 3, 4, 5}, "SCALAR");
    const Appearance appearance = appearance_of(sample.saved());
    ASSERT_EQ(appearance.triangles.size(), 2u);
    for (int t = 0; t < 2; ++t)
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(appearance.coordinates[size_t(t)][size_t(k)], Vec2(0.125 * (3 * t + k), 0.5));
}

TEST(Appearance, TurnsWithTrianglesThatAreTurned)
{
    // A tetrahedron that is inside out.
    GltfSample sample = textured_triangle();
    sample.at(kPrimitive + "/attributes/POSITION") =
        sample.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3");
    sample.at(kPrimitive + "/attributes/TEXCOORD_0") = sample.add(numbered_coordinates(4), "VEC2");
    sample.at(kPrimitive + "/indices") =
        sample.add<std::uint16_t>({0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2}, "SCALAR");
    AvatarSettings settings;
    settings.file = sample.saved();
    const std::unique_ptr<Avatar> avatar = load_avatar(settings);
    ASSERT_EQ(avatar->turned_count(), 4);
    const Appearance appearance = load_appearance(settings.file, avatar->triangles());
    for (size_t t = 0; t < 4; ++t)
        for (size_t k = 0; k < 3; ++k)
            EXPECT_EQ(appearance.coordinates[t][k].x(), 0.125 * avatar->triangles()[t][int(k)]);
    EXPECT_THROW(load_appearance(settings.file, {Triangle(0, 1, 2)}), InvalidInput);
}

TEST(Appearance, HasTheMaterialOfEachPrimitiveOnSharedVertices)
{
    GltfSample sample = textured_triangle();
    sample.at("/meshes/0/primitives").push_back(sample.at(kPrimitive));
    nlohmann::json& other = sample.at("/meshes/0/primitives/1");
    other["attributes"]["TEXCOORD_1"] = sample.add<float>({1, 0, 1, 0, 1, 0}, "VEC2");
    other["material"] = 1;
    sample.at("/materials")
        .push_back({{"alphaMode", "MASK"},
                    {"alphaCutoff", 0.25},
                    {"pbrMetallicRoughness",
                     {{"baseColorFactor", {0.5, 0.25, 1.0, 0.75}},
                      {"baseColorTexture", {{"index", 1}, {"texCoord", 1}}}}}});
    sample.at("/textures").push_back({{"source", 0}, {"sampler", 0}});
    sample.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
    const Appearance appearance = appearance_of(sample.saved());
    EXPECT_THAT(appearance.material, ElementsAre(0, 1));
    EXPECT_EQ(appearance.images.size(), 1u);
    EXPECT_EQ(appearance.coordinates[0][1], Vec2(0.125, 0.5));
    EXPECT_EQ(appearance.coordinates[1][1], Vec2(1, 0));
    EXPECT_EQ(appearance.materials[1].colour, Vec3(0.5, 0.25, 1.0));
    EXPECT_EQ(appearance.materials[1].alpha, 0.75);
    EXPECT_EQ(appearance.materials[1].cutoff, 0.25);
    EXPECT_THAT(appearance.materials[1].texture->wrap, ElementsAre(Wrap::Clamp, Wrap::Mirror));
}

TEST(Appearance, TransformsCoordinates)
{
    GltfSample sample = textured_triangle();
    sample.at("/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform") = {
        {"offset", {0.5, 0.25}}, {"rotation", 0.5 * std::numbers::pi}, {"scale", {2.0, 4.0}}};
    // (0.25, 0.5) is scaled to (0.5, 2), and turned counter-clockwise, where v points down, to (2, -0.5).
    const Appearance appearance = appearance_of(sample.saved());
    EXPECT_LT((appearance.coordinates[0][2] - Vec2(2.5, -0.25)).norm(), 1e-12);
}

TEST(Appearance, HasColoursOfVertices)
{
    GltfSample sample = GltfSample::triangle();
    sample.at(kPrimitive + "/attributes/COLOR_0") =
        sample.add<std::uint8_t>({255, 0, 0, 0, 255, 0, 0, 0, 51}, "VEC3", true);
    const Appearance appearance = appearance_of(sample.saved());
    ASSERT_EQ(appearance.colours.size(), 1u);
    EXPECT_EQ(appearance.colours[0][0], Eigen::Vector4d(1, 0, 0, 1));
    EXPECT_EQ(appearance.colours[0][2], Eigen::Vector4d(0, 0, 0.2, 1));
    EXPECT_EQ(appearance.materials[0].colour, Vec3::Ones());
}

TEST(Appearance, IsEmptyWithoutColours)
{
    EXPECT_TRUE(appearance_of(GltfSample::triangle().saved()).is_empty());
    GltfSample sample = textured_triangle();
    sample.json["materials"] = {{{"name", "bare"}, {"pbrMetallicRoughness", {{"roughnessFactor", 0.5}}}}};
    EXPECT_TRUE(appearance_of(sample.saved()).is_empty());
}

TEST(Appearance, TellsWhatItLeavesOut)
{
    const auto left_out = [](const GltfSample& sample) {
        const Appearance appearance = appearance_of(sample.saved());
        return appearance.left_out.empty() ? "" : appearance.left_out[0];
    };
    GltfSample missing = textured_triangle();
    missing.at("/images/0/uri") = "no.png";
    EXPECT_THAT(left_out(missing), HasSubstr("images[0].uri = \"no.png\": no such file beside this one"));
    missing.at("/images/0/uri") = "data:image/png;base64,";
    EXPECT_THAT(left_out(missing), HasSubstr("images[0].uri = \"data:image/png;base64,\": is empty"));
    GltfSample compressed = textured_triangle();
    compressed.json["textures"] = {{{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}}};
    EXPECT_THAT(left_out(compressed), HasSubstr("textures[0] names no PNG or JPEG image"));
    GltfSample bare = textured_triangle();
    bare.at(kPrimitive + "/attributes").erase("TEXCOORD_0");
    EXPECT_THAT(left_out(bare), HasSubstr("attributes has no TEXCOORD_0 for its image"));
}

TEST(Appearance, RefusesMaterialsThatBreakTheSpecification)
{
    GltfSample sample = textured_triangle();
    sample.at("/textures/0/source") = 7;
    EXPECT_THROW(appearance_of(sample.saved()), InvalidInput);
    sample = textured_triangle();
    sample.at(kPrimitive + "/attributes/TEXCOORD_0") = sample.add(numbered_coordinates(2), "VEC2");
    EXPECT_THROW(appearance_of(sample.saved()), InvalidInput);
}

TEST(Appearance, ReadsMaterialsOfObj)
{
    const TemporaryFolder folder;
    folder.write("skin.png", "\x01\x02");
    folder.write("empty.png", "");
    folder.write("body.mtl", "newmtl shirt\r\nKd 0 0 0\r\nmap_Kd -clamp on -s 1 1 1 C:\\art\\skin.png\r\n"
                             "newmtl eyes\nKd 0.1 0.2 0.3\nnewmtl hat\nmap_Kd lost.png\n"
                             "newmtl shoe\nmap_Kd empty.png\n");
    const auto file =
        folder.write("body.obj", "mtllib body.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                                 "vt 0.25 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                                 "usemtl shirt\nf 1/1 2/2 3/3 4/4\nusemtl eyes\nf 1/1 3/3 2/2\n");
    const Appearance appearance = appearance_of(file);
    EXPECT_THAT(appearance.material, ElementsAre(0, 0, 1));
    EXPECT_EQ(appearance.materials[1].colour, Vec3(0.1, 0.2, 0.3));
    EXPECT_FALSE(appearance.materials[0].colour);
    ASSERT_TRUE(appearance.materials[0].texture);
    EXPECT_THAT(appearance.materials[0].texture->wrap, ElementsAre(Wrap::Clamp, Wrap::Clamp));
    EXPECT_THAT(appearance.images[0].bytes, ElementsAre(1, 2));
    EXPECT_THAT(appearance.files, ElementsAre(folder.path() / "body.mtl", folder.path() / "skin.png",
                                              folder.path() / "empty.png"));
    EXPECT_THAT(appearance.left_out,
                ElementsAre(HasSubstr("body.mtl:7: image \"lost.png\": no such file"),
                            HasSubstr("body.mtl:9: image \"empty.png\": is empty, or can't be read")));
    ASSERT_EQ(appearance.triangles[0][0], 0);
    EXPECT_EQ(appearance.coordinates[0][0], Vec2(0.25, 1.0)); // v of OBJ points up
}

TEST(Appearance, ReadsModelsThatAssimpReads)
{
    const TemporaryFolder folder;
    folder.write("skin.png", "\x01\x02");
    const auto file = folder.write("body.dae", R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit meter="1"/><up_axis>Y_UP</up_axis></asset>
  <library_images><image id="skin"><init_from>skin.png</init_from></image></library_images>
  <library_effects><effect id="e"><profile_COMMON>
    <newparam sid="f"><surface type="2D"><init_from>skin</init_from></surface></newparam>
    <newparam sid="s"><sampler2D><source>f</source></sampler2D></newparam>
    <technique sid="t"><phong><diffuse><texture texture="s" texcoord="UV"/></diffuse></phong></technique>
  </profile_COMMON></effect></library_effects>
  <library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
  <library_geometries><geometry id="g"><mesh>
    <source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
      <accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
        <param name="Z" type="float"/></accessor></technique_common></source>
    <source id="u"><float_array id="ua" count="6">0 0.25 1 0 1 1</float_array><technique_common>
      <accessor source="#ua" count="3" stride="2"><param name="S" type="float"/><param name="T" type="float"/>
      </accessor></technique_common></source>
    <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
    <triangles count="1" material="k"><input semantic="VERTEX" source="#v" offset="0"/>
      <input semantic="TEXCOORD" source="#u" offset="1" set="0"/><p>0 0 1 1 2 2</p></triangles>
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="vs"><node id="n"><instance_geometry url="#g"><bind_material>
    <technique_common><instance_material symbol="k" target="#m"/></technique_common></bind_material>
  </instance_geometry></node></visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#vs"/></scene>
</COLLADA>)");
    const Appearance appearance = appearance_of(file);
    ASSERT_EQ(appearance.triangles.size(), 1u);
    ASSERT_EQ(appearance.images.size(), 1u);
    EXPECT_THAT(appearance.images[0].bytes, ElementsAre(1, 2));
    EXPECT_TRUE(appearance.materials[size_t(appearance.material[0])].texture);
    ASSERT_EQ(appearance.triangles[0][0], 0);
    EXPECT_EQ(appearance.coordinates[0][0], Vec2(0.0, 0.75)); // v of Collada points up
}

TEST(Appearance, ReadsColoursOfObjVerticesAsSrgb)
{
    const TemporaryFolder folder;
    const Appearance appearance = appearance_of(
        folder.write("scan.obj", "v 0 0 0 1 0 0.5\nv 1 0 0 1 0 0.5\nv 0 1 0 1 0 0.5\nf 1 2 3\n"));
    EXPECT_LT((appearance.colours[0][1] - Eigen::Vector4d(1, 0, 0.214041, 1)).norm(), 1e-6);
    EXPECT_EQ(appearance.materials[size_t(appearance.material[0])].colour, Vec3::Ones());
}

} // namespace toile::test
