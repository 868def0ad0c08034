#include "avatars/import/assimp_import.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

using namespace avatars;

namespace {

/// A Collada file: one triangle whose node moves along X, with the given key times, values and corners.
std::string collada(const std::string& times, const std::string& values, const std::string& corners = "0 1 2")
{
    return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>)" +
           corners + R"(</p></triangles>
</mesh></geometry></library_geometries>
<library_animations><animation id="a">
<source id="t"><float_array id="ta" count="2">)" +
           times + R"(</float_array><technique_common>
<accessor source="#ta" count="2" stride="1"><param name="TIME" type="float"/></accessor></technique_common></source>
<source id="o"><float_array id="oa" count="6">)" +
           values + R"(</float_array><technique_common>
<accessor source="#oa" count="2" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<sampler id="s"><input semantic="INPUT" source="#t"/><input semantic="OUTPUT" source="#o"/></sampler>
<channel source="#s" target="n/move"/></animation></library_animations>
<library_visual_scenes><visual_scene id="vs"><node id="n" name="n"><translate sid="move">0 0 0</translate>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#vs"/></scene>
</COLLADA>)";
}

RiggedModel import(const std::string& content, const std::string& extension = ".dae")
{
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    const std::filesystem::path file = process_folder() / ("toile_" + std::string(test->name()) + extension);
    std::ofstream(file) << content;
    return import_rigged_model(file);
}

std::string refusal(const std::string& content, const std::string& extension = ".dae")
{
    try {
        import(content, extension);
        return "";
    } catch (const InvalidInput& error) {
        return error.what();
    }
}

} // namespace

TEST(AssimpImport, ReadsAMovingColladaNode)
{
    const RiggedModel model = import(collada("0 2", "0 0 0 3 0 0"));
    ASSERT_EQ(model.clips.size(), 1u);
    EXPECT_EQ(model.mesh.rest.triangles.size(), 1u);
    SkinnedAvatar avatar("sample", model);
    std::vector<Vec3> x(3);
    avatar.pose({0, 1.0}, identity_affine(), x);
    EXPECT_NEAR(x[0].x(), 1.5, 1e-6);
}

TEST(AssimpImport, RefusesKeysThatAreNotFinite)
{
    const std::string message = refusal(collada("0 2", "0 0 0 nan 0 0"));
    EXPECT_NE(message.find("joint 'n': "), std::string::npos) << message;
    EXPECT_NE(message.find("has a value that is not finite"), std::string::npos) << message;
}

TEST(AssimpImport, SaysWhatAssimpSays)
{
    const std::string message = refusal("<COLLADA");
    EXPECT_NE(message.find("can't be read as a model ("), std::string::npos) << message;
    EXPECT_EQ(message.find("()"), std::string::npos) << message;
}

/// Files for which assimp 5.2 stops at an assert of its own, dies of an access out of bounds or fills the
/// memory.
TEST(AssimpImport, SurvivesItsReaders)
{
    const std::string points = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                               "property float z\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
    const std::string fan =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 4294967295\nproperty list uchar int vertex_indices\n"
        "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    for (const auto& [content, extension] :
         std::vector<std::pair<std::string, std::string>>{{collada("0 2", "0 0 0 3 0 0", "0 1 9"), ".dae"},
                                                          {points, ".ply"},
                                                          {fan, ".ply"},
                                                          {"no archive", ".3mf"}}) {
        const std::string message = refusal(content, extension);
        EXPECT_NE(message.find("SurvivesItsReaders" + extension + ": can't be read"), std::string::npos)
            << message;
    }
}

} // namespace toile::test
