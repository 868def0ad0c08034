#include "avatars/import/gltf_import.h"

#include <gtest/gtest.h>

#include "avatars/load_avatar.h"
#include "avatars/model/moving_avatar.h"
#include "core/base/error.h"
#include "tests/avatars/gltf_sample.h"

namespace toile::test {

using namespace avatars;

namespace {

SkinnedAvatar load(const GltfSample& sample) { return {"sample", import_gltf(sample.saved())}; }

/// Message of the import; empty if it accepts the file.
std::string refusal(const std::filesystem::path& file)
{
    try {
        import_gltf(file);
        return "";
    } catch (const InvalidInput& error) {
        return error.what();
    }
}

std::vector<std::string> joint_names(const RiggedModel& model)
{
    std::vector<std::string> names;
    for (const Joint& joint : model.skeleton.joints())
        names.push_back(joint.name);
    return names;
}

std::vector<std::string> clip_names(const RiggedModel& model)
{
    std::vector<std::string> names;
    for (const Clip& clip : model.clips)
        names.push_back(clip.name);
    return names;
}

void expect_near(const std::vector<Vec3>& found, const std::vector<Vec3>& expected, double tolerance)
{
    ASSERT_EQ(found.size(), expected.size());
    for (size_t v = 0; v < found.size(); ++v)
        EXPECT_LT((found[v] - expected[v]).norm(), tolerance)
            << "vertex " << v << ": " << found[v].transpose();
}

const std::vector<Vec3> kTriangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
constexpr const char* kAttributes = "/meshes/0/primitives/0/attributes";

/// The triangle with two shapes of one vertex each: corner 1 along X, corner 2 along Y.
GltfSample shaped_triangle()
{
    GltfSample sample = GltfSample::triangle();
    const int along_x = sample.add<float>({0, 0, 0, 1, 0, 0, 0, 0, 0}, "VEC3");
    const int along_y = sample.add<float>({0, 0, 0, 0, 0, 0, 0, 1, 0}, "VEC3");
    sample.at("/meshes/0/primitives/0/targets") = {{{"POSITION", along_x}}, {{"POSITION", along_y}}};
    return sample;
}

} // namespace

TEST(Gltf, ReadsASkinWithoutInverseBindMatricesAsIdentity)
{
    GltfSample sample = GltfSample::column();
    SkinnedAvatar bound = load(sample);
    std::vector<Vec3> expected = posed(bound, {});
    // The tip then takes what follows it half a metre up.
    const RiggedModel model = import_gltf(sample.saved());
    for (int v = 0; v < model.mesh.rest.vertex_count(); ++v)
        for (int k = model.mesh.first[v]; k < model.mesh.first[v + 1]; ++k)
            if (model.mesh.bones[model.mesh.influences[k].bone].joint_from_mesh != identity_affine())
                expected[size_t(v)].y() += 0.5 * model.mesh.influences[k].weight;
    sample.at("/skins/0").erase("inverseBindMatrices");
    SkinnedAvatar avatar = load(sample);
    expect_near(posed(avatar, {}), expected, 1e-7);
}

TEST(Gltf, ReadsNormalisedWeights)
{
    GltfSample sample = GltfSample::column();
    const std::vector<std::uint8_t> half(60, 51);
    sample.at(kAttributes)["WEIGHTS_0"] = sample.add(half, "VEC4", true);
    sample.at(kAttributes)["JOINTS_0"] = sample.add(std::vector<std::uint16_t>(60, 1), "VEC4");
    SkinnedAvatar avatar = load(sample); // all of it follows the tip, with weights of sum 0.8
    const Affine turn = [] {
        Affine map = identity_affine();
        map.leftCols<3>() = Eigen::AngleAxisd(std::acos(0.0), Vec3::UnitZ()).toRotationMatrix();
        map.col(3) = Vec3(0.5, 0.5, 0);
        return map;
    }();
    std::vector<Vec3> expected = avatar.model().mesh.rest.positions;
    for (Vec3& x : expected)
        x = apply(turn, x);
    expect_near(posed(avatar, {avatar.clip_index("bend"), 1.0}), expected, 1e-6);
}

TEST(Gltf, ReadsQuantizedPositions)
{
    GltfSample sample = GltfSample::triangle();
    sample.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    sample.at(kAttributes)["POSITION"] =
        sample.add<std::int16_t>({0, 0, -32768, 32767, 0, -32767, 0, 16384, 0}, "VEC3", true);
    SkinnedAvatar scaled = load(sample);
    expect_near(posed(scaled, {}), {{0, 0, -1}, {1, 0, -1}, {0, 16384.0 / 32767.0, 0}}, 1e-12);

    sample.at(kAttributes)["POSITION"] = sample.add<std::uint8_t>({0, 0, 0, 200, 0, 0, 0, 100, 7}, "VEC3");
    sample.json["nodes"][0]["scale"] = {0.01, 0.02, 1};
    SkinnedAvatar whole = load(sample);
    expect_near(posed(whole, {}), {{0, 0, 0}, {2, 0, 0}, {0, 2, 7}}, 1e-12);
}

TEST(Gltf, KeepsNodesOfOneNameApart)
{
    GltfSample sample = GltfSample::column();
    SkinnedAvatar original = load(sample);
    for (nlohmann::json& node : sample.json["nodes"])
        node["name"] = "Bone";
    SkinnedAvatar avatar = load(sample);
    EXPECT_EQ(joint_names(avatar.model()), (std::vector<std::string>{"Bone", "Bone#2", "Bone#3"}));
    EXPECT_EQ(posed(avatar, {0, 0.6}), posed(original, {0, 0.6}));
}

TEST(Gltf, KeepsErrorsOnOneLineWhateverIsInTheFile)
{
    GltfSample sample = GltfSample::column();
    for (const int node : {1, 2}) {
        sample.json["nodes"][size_t(node)]["name"] = "two\nlines";
        sample.json["nodes"][size_t(node)]["scale"] = {1e200, 1, 1};
    }
    EXPECT_NE(refusal(sample.saved()).find("joint 'two lines#2'"), std::string::npos);

    const std::string long_name(5000, 'a');
    sample.json["buffers"][0]["uri"] = long_name;
    EXPECT_LT(refusal(sample.saved()).size(), 300u);
}

TEST(Gltf, ReachesBothClipsOfOneName)
{
    GltfSample sample = GltfSample::column();
    sample.json["animations"][1]["name"] = "bend";
    const SkinnedAvatar avatar = load(sample);
    EXPECT_EQ(clip_names(avatar.model()), (std::vector<std::string>{"bend", "bend#2"}));
    EXPECT_DOUBLE_EQ(avatar.clips()[avatar.clip_index("bend#2")].duration, 2.0);
}

TEST(Gltf, NumbersAroundNamesThatLookNumbered)
{
    GltfSample sample = GltfSample::column();
    const char* names[] = {"a", "a", "a#2"};
    for (size_t i = 0; i < 3; ++i)
        sample.json["nodes"][i]["name"] = names[i];
    EXPECT_EQ(joint_names(import_gltf(sample.saved())), (std::vector<std::string>{"a", "a#3", "a#2"}));
}

TEST(Gltf, TurnsTrianglesThatANodeMirrors)
{
    GltfSample sample = GltfSample::triangle();
    EXPECT_EQ(import_gltf(sample.saved()).mesh.rest.triangles, std::vector<Triangle>{Triangle(0, 1, 2)});
    sample.json["nodes"][0]["scale"] = {-1, 1, 1};
    EXPECT_EQ(import_gltf(sample.saved()).mesh.rest.triangles, std::vector<Triangle>{Triangle(0, 2, 1)});
    sample.json["nodes"][0].erase("scale");
    sample.json["nodes"][0]["matrix"] = {0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; // swaps x and y
    SkinnedAvatar swapped = load(sample);
    EXPECT_EQ(swapped.triangles(), std::vector<Triangle>{Triangle(0, 2, 1)});
    expect_near(posed(swapped, {}), {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}, 1e-12);
}

TEST(Gltf, AppliesBlendShapesAtTheWeightsOfTheNodeElseOfTheMesh)
{
    GltfSample sample = shaped_triangle();
    EXPECT_EQ(import_gltf(sample.saved()).mesh.rest.positions, kTriangle);
    sample.json["meshes"][0]["weights"] = {1.0, -0.5};
    EXPECT_EQ(import_gltf(sample.saved()).mesh.rest.positions,
              (std::vector<Vec3>{{0, 0, 0}, {2, 0, 0}, {0, 0.5, 0}}));
    sample.json["nodes"][0]["weights"] = {0.0, 2.0};
    EXPECT_EQ(import_gltf(sample.saved()).mesh.rest.positions,
              (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 3, 0}}));
}

TEST(Gltf, MovesBlendShapesWithTheirClip)
{
    GltfSample sample = shaped_triangle();
    sample.json["meshes"][0]["weights"] = {0.0, 0.5};
    sample.animate("grow", 0, "weights", sample.add<float>({0, 2}, "SCALAR"),
                   sample.add<float>({0, 0, 3, 1}, "SCALAR"));
    SkinnedAvatar avatar = load(sample);
    EXPECT_DOUBLE_EQ(avatar.clips()[0].duration, 2.0);
    expect_near(posed(avatar, {}), {{0, 0, 0}, {1, 0, 0}, {0, 1.5, 0}}, 1e-15);
    expect_near(posed(avatar, {0, 1.0}), {{0, 0, 0}, {2.5, 0, 0}, {0, 1.5, 0}}, 1e-15);
    expect_near(posed(avatar, {0, 2.0}), {{0, 0, 0}, {4, 0, 0}, {0, 2, 0}}, 1e-15);
    expect_near(posed(avatar, {0, 2.0, 0.5}), {{0, 0, 0}, {2.5, 0, 0}, {0, 1.75, 0}}, 1e-15);
}

TEST(Gltf, BoundsTheMotionOfBlendShapesAhead)
{
    GltfSample sample = shaped_triangle();
    sample.json["nodes"][0]["scale"] = {2, 2, 2};
    sample.animate("grow", 0, "weights", sample.add<float>({0, 2}, "SCALAR"),
                   sample.add<float>({0, 0, 3, 1}, "SCALAR"));
    Motion motion;
    motion.clip = "grow";
    MovingAvatar moving(std::make_unique<SkinnedAvatar>("sample", import_gltf(sample.saved())), motion,
                        Placement{});
    const double bound = moving.max_motion_to(1.0);
    moving.advance_to(1.0);
    EXPECT_GE(bound, 3.0); // corner 1 moves by 2 * 1.5
    EXPECT_LT(bound, 3.0 * 3.0);
}

TEST(Gltf, JoinsTheOffsetsOfASeam)
{
    // Two triangles along a common edge, whose vertices are there twice.
    GltfSample sample = GltfSample::triangle();
    const std::vector<float> corners{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    sample.at(kAttributes)["POSITION"] = sample.add(corners, "VEC3");
    const int raised = sample.add<float>({0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    sample.at("/meshes/0/primitives/0/targets") = {{{"POSITION", raised}}};
    sample.animate("raise", 0, "weights", sample.add<float>({0, 1}, "SCALAR"),
                   sample.add<float>({0, 2}, "SCALAR"));
    SkinnedAvatar avatar = load(sample);
    expect_near(posed(avatar, {0, 1.0}), {{0, 0, 0}, {1, 0, 2}, {0, 1, 2}, {1, 1, 2}}, 1e-12);
}

TEST(Gltf, ChoosesTheReaderByContentToo)
{
    // A .glb without its extension.
    const std::string json = GltfSample::triangle().json.dump();
    const auto number = [](size_t value) {
        std::string bytes(4, '\0');
        for (size_t i = 0; i < 4; ++i)
            bytes[i] = char(value >> (8 * i));
        return bytes;
    };
    const std::string content =
        "glTF" + number(2) + number(20 + json.size()) + number(json.size()) + "JSON" + json;
    AvatarSettings settings;
    settings.file = GltfSample::save_text(content).replace_extension(".body");
    std::ofstream(settings.file, std::ios::binary) << content;
    EXPECT_EQ(load_avatar(settings)->vertex_count(), 3);

    // No cut of it is read, and none crashes.
    for (size_t size = 0; size < content.size(); ++size)
        EXPECT_NE(refusal(GltfSample::save_text(content.substr(0, size))), "") << size;
}

TEST(Gltf, ReadsNodesInADeepChain)
{
    GltfSample sample = GltfSample::triangle();
    nlohmann::json& nodes = sample.json["nodes"];
    constexpr int kDepth = 10000;
    nodes = nlohmann::json::array();
    for (int i = 0; i + 1 < kDepth; ++i)
        nodes.push_back({{"children", {i + 1}}, {"translation", {0, 0, 1}}});
    nodes.push_back({{"mesh", 0}});
    SkinnedAvatar avatar = load(sample);
    expect_near(posed(avatar, {}), {{0, 0, 9999}, {1, 0, 9999}, {0, 1, 9999}}, 1e-9);
}

TEST(Gltf, SurvivesDeeplyNestedJson)
{
    constexpr size_t kDepth = 100000;
    std::string text = GltfSample::triangle().json.dump();
    text.back() = ',';
    text += "\"extras\":" + std::string(kDepth, '[') + std::string(kDepth, ']') + "}";
    EXPECT_EQ(refusal(GltfSample::save_text(text)), "");
    EXPECT_NE(refusal(GltfSample::save_text(std::string(kDepth, '['))).find("can't be read"),
              std::string::npos);
}

/// One change to the column's JSON, and what its refusal says.
struct Mutant {
    const char* name;
    const char* pointer;
    const char* value; ///< JSON; empty: the key is removed
    const char* message;
};

class GltfMutant : public testing::TestWithParam<Mutant> {};

TEST_P(GltfMutant, IsRefusedInOneLineThatNamesThePlace)
{
    const Mutant& mutant = GetParam();
    GltfSample sample = GltfSample::column();
    const nlohmann::json::json_pointer pointer(mutant.pointer);
    if (*mutant.value == '\0')
        sample.json[pointer.parent_pointer()].erase(pointer.back());
    else
        sample.json[pointer] = nlohmann::json::parse(mutant.value);
    const std::string message = refusal(sample.saved());
    EXPECT_NE(message.find(".gltf: " + std::string(mutant.message)), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    Import, GltfMutant,
    testing::Values(
        Mutant{"NoAsset", "/asset", "", "asset is missing"},
        Mutant{"OldVersion", "/asset/version", "\"1.0\"",
               "asset.version = \"1.0\": version 2 of glTF is read"},
        Mutant{"Draco", "/extensionsRequired", "[\"KHR_draco_mesh_compression\"]",
               "extensionsRequired[0] = \"KHR_draco_mesh_compression\": this extension is not read; save the "
               "file "
               "without compression"},
        Mutant{"HugeCount", "/accessors/0/count", "4294967296", "accessors[0].count = 4294967296: must be"},
        Mutant{"LongCount", "/accessors/0/count", "2147483647",
               "accessors[0].count = 2147483647: elements of 12"},
        Mutant{"ZerosOfNoFile", "/accessors/0",
               R"({"componentType": 5126, "type": "VEC3", "count": 2000000000})",
               "accessors[0].count = 2000000000: from here on the file repeats"},
        Mutant{"NegativeOffset", "/bufferViews/0/byteOffset", "-1",
               "bufferViews[0].byteOffset = -1: must be"},
        Mutant{
            "OffsetNearOverflow", "/bufferViews/0/byteOffset", "9007199254740992",
            "bufferViews[0].byteLength = 180: with offset 9007199254740992 the view ends after its buffer"},
        Mutant{"ViewOfNoBuffer", "/bufferViews/0/buffer", "3",
               "bufferViews[0].buffer = 3: index 3 is out of bounds of 1 buffers"},
        Mutant{"ShortStride", "/bufferViews/0/byteStride", "8", "bufferViews[0].byteStride = 8: must be"},
        Mutant{"ShortBuffer", "/buffers/0/byteLength", "2000",
               "buffers[0].byteLength = 2000: the buffer has 1040"},
        Mutant{"NoBase64", "/buffers/0/uri", "\"data:;base64,A*A=\"",
               "buffers[0].uri = \"data:;base64,A*A=\": "},
        Mutant{"Remote", "/buffers/0/uri", "\"https://a/b\"",
               "buffers[0].uri = \"https://a/b\": 'https:' is not"},
        Mutant{"NoFile", "/buffers/0/uri", "\"no%20file.bin\"",
               "buffers[0].uri = \"no%20file.bin\": no such file beside this one"},
        Mutant{"NoType", "/accessors/0/type", "", "accessors[0].type is missing"},
        Mutant{"WrongType", "/accessors/0/type", "\"VEC2\"",
               "accessors[0].type = \"VEC2\": it is used where"},
        Mutant{"WrongComponents", "/accessors/2/componentType", "5126",
               "accessors[2].componentType = 5126: it is"},
        Mutant{"TextForIndex", "/nodes/0/skin", "\"0\"",
               "nodes[0].skin = \"0\": must be the index of one of 1 skins"},
        Mutant{"IndexBeyond32Bits", "/nodes/0/mesh", "4294967296",
               "nodes[0].mesh = 4294967296: index 4294967296 is out of bounds of 1 meshes"},
        Mutant{"TwoParents", "/nodes/0/children", "[2]",
               "nodes[1].children[0] = 2: this node is already a child"},
        Mutant{"Cycle", "/nodes/2/children", "[1]",
               "scenes[0].nodes[1] = 1: this node is a child of nodes[2]"},
        Mutant{"SelfParent", "/nodes", R"([{"mesh": 0}, {}, {"children": [2]}])",
               "nodes[2] = {...}: this node is below"},
        Mutant{"TextInNumbers", "/nodes/2/translation/1", "\"a\"",
               "nodes[2].translation = [...]: must be an array"},
        Mutant{"ShortVector", "/nodes/2/translation", "[1, 2]",
               "nodes[2].translation = [...]: must have 3 numbers"},
        Mutant{"NoRotation", "/nodes/2/rotation", "[0, 0, 0, 0]", "nodes[2].rotation = [...]: a rotation is"},
        Mutant{"Shear", "/nodes/2", R"({"matrix": [1,0,0,0, 1,1,0,0, 0,0,1,0, 0,0,0,1]})",
               "nodes[2].matrix = [...]: it must be a translation, rotation and scale"},
        Mutant{"Projection", "/nodes/2", R"({"matrix": [1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1]})",
               "nodes[2].matrix = [...]: the fourth row"},
        Mutant{
            "Overflow", "/nodes",
            R"([{"mesh": 0, "skin": 0}, {"scale": [1e200, 1, 1], "children": [2]}, {"scale": [1e200, 1, 1]}])",
            "joint 'nodes_2': its transform in the bind pose is not finite"},
        Mutant{"NoJoints", "/meshes/0/primitives/0/attributes/JOINTS_0", "",
               "meshes[0].primitives[0].attributes.JOINTS_0 is missing"},
        Mutant{"FewJoints", "/skins/0/joints", "[1]",
               "meshes[0].primitives[0].attributes.JOINTS_0 = 2: vertex 5 follows joint 1; the skin has 1"},
        Mutant{"FewMatrices", "/skins/0/joints", "[1, 2, 0]",
               "skins[0].inverseBindMatrices = 5: this accessor has 2"},
        Mutant{"OtherCount", "/meshes/0/primitives/0/attributes/WEIGHTS_0", "7",
               "meshes[0].primitives[0].attributes.WEIGHTS_0 = 7: this accessor has 2 elements; 15"},
        Mutant{"IndexOfNoVertex", "/bufferViews/1/byteOffset", "181",
               "meshes[0].primitives[0].indices = 1: index 0 of this accessor is "},
        Mutant{"NoTriangles", "/accessors/1/count", "59", "meshes[0].primitives[0] has 59 corners"},
        Mutant{"UnknownMode", "/meshes/0/primitives/0/mode", "7",
               "meshes[0].primitives[0].mode = 7: must be"},
        Mutant{"OnlyPoints", "/meshes/0/primitives/0/mode", "0", "no mesh with triangles"},
        Mutant{"UnknownPath", "/animations/0/channels/0/target/path", "\"colour\"",
               "animations[0].channels[0].target.path = \"colour\": must be"},
        Mutant{"UnknownInterpolation", "/animations/0/samplers/0/interpolation", "\"CUBIC\"",
               "animations[0].samplers[0].interpolation = \"CUBIC\": must be LINEAR, STEP or CUBICSPLINE"},
        Mutant{"FewValues", "/animations/0/samplers/0/interpolation", "\"CUBICSPLINE\"",
               "animations[0].samplers[0].output = 7: this accessor has 2 elements; the keys need 6"},
        Mutant{"NoShapes", "/animations/0/channels/0/target", R"({"node": 0, "path": "weights"})",
               "animations[0].channels[0].target.node = 0: the mesh of this node has no targets"}),
    [](const auto& mutant) { return std::string(mutant.param.name); });

/// Numbers that replace the accessor at a place of the column, and what the refusal says.
struct BadNumbers {
    const char* name;
    const char* pointer;
    const char* type;
    std::vector<float> numbers;
    const char* message;
};

class GltfBadNumbers : public testing::TestWithParam<BadNumbers> {};

TEST_P(GltfBadNumbers, AreRefusedWithTheirPlace)
{
    const BadNumbers& bad = GetParam();
    GltfSample sample = GltfSample::column();
    const int accessor = sample.add(bad.numbers, bad.type);
    sample.at(bad.pointer) = accessor;
    const std::string message = refusal(sample.saved());
    EXPECT_NE(message.find(bad.message), std::string::npos) << message;
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

/// One number repeated, with another in its place.
std::vector<float> filled(size_t count, float number, size_t place, float other)
{
    std::vector<float> numbers(count, number);
    numbers[place] = other;
    return numbers;
}

INSTANTIATE_TEST_SUITE_P(
    Import, GltfBadNumbers,
    testing::Values(
        BadNumbers{"RotationKey", "/animations/0/samplers/0/output", "VEC4", filled(8, 0.5f, 5, kNan),
                   "animations[0].samplers[0].output = 10: number 1 of element 1 of this accessor is nan"},
        BadNumbers{"RotationOfLength0",
                   "/animations/0/samplers/0/output",
                   "VEC4",
                   {0, 0, 0, 1, 0, 0, 0, 0},
                   "animations[0].samplers[0]: key 1 is a quaternion of length 0"},
        BadNumbers{"KeyTime",
                   "/animations/0/samplers/0/input",
                   "SCALAR",
                   {0, kInf},
                   "animations[0].samplers[0].input = 10: number 0 of element 1 of this accessor is inf"},
        BadNumbers{"DescendingTimes",
                   "/animations/0/samplers/0/input",
                   "SCALAR",
                   {1, 0.5f},
                   "animations[0].samplers[0]: key 1 at 0.500000 s comes after one at 1.000000 s"},
        BadNumbers{"NegativeTime",
                   "/animations/0/samplers/0/input",
                   "SCALAR",
                   {-1, 0.5f},
                   "animations[0].samplers[0].input = 10: key 0 is at -1.000000 s"},
        BadNumbers{"InverseBindMatrix", "/skins/0/inverseBindMatrices", "MAT4", filled(32, 1, 17, kNan),
                   "skins[0].inverseBindMatrices = 10: number 1 of element 1 of this accessor is nan"},
        BadNumbers{"Weight", "/meshes/0/primitives/0/attributes/WEIGHTS_0", "VEC4", filled(60, 1, 9, -kInf),
                   "attributes.WEIGHTS_0 = 10: number 1 of element 2 of this accessor is -inf"},
        BadNumbers{"Position", "/meshes/0/primitives/0/attributes/POSITION", "VEC3", filled(45, 1, 4, kNan),
                   "attributes.POSITION = 10: number 1 of element 1 of this accessor is nan"}),
    [](const auto& bad) { return std::string(bad.param.name); });

} // namespace toile::test
