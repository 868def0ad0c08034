#include <gtest/gtest.h>

#include "core/base/error.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"

namespace toile::test {

using namespace scenes;

namespace {

/// Cloth whose left edge, at x = 0.8 m, turns by 90 degrees about the vertical.
std::vector<Vec3> turned(const std::string& more)
{
    World world(parse_scene(R"({"toile": 1, "frames": 16, "gravity": [0, 0, 0], "cloths": [{"name": "c",
        "rectangle": {"size": [0.4, 0.4], "resolution": 0.1}, "translate": [1, 1, 0]}], "attachments": [
        {"cloth": "c", "select": {"box": {"lower": [0.7, 0.9, -1], "upper": [0.85, 1.1, 1]}}, "keyframes":
        [{"time": 0}, {"time": 0.4, "rotate_deg": [0, 90, 0]}])" +
                                more + "}]}",
                            "turn.json"));
    const std::vector<unsigned char> attached = world.cloths()[0].attached(0.0);
    while (world.frame() + 1 < world.frame_count())
        world.advance_frame();
    std::vector<Vec3> edge;
    for (int v = 0; v < int(attached.size()); ++v)
        if (attached[size_t(v)] != 0)
            edge.push_back(world.cloths()[0].positions[size_t(v)]);
    return edge;
}

TEST(Attachments, TurnAboutTheirCentreOrAStatedPivot)
{
    // The edge lies along Z and ends along X.
    for (const Vec3& x : turned("")) {
        EXPECT_NEAR(x.z(), 0.0, 1e-6);
        EXPECT_LE(std::abs(x.x() - 0.8), 0.2 + 1e-6);
    }
    for (const Vec3& x : turned(R"(, "pivot": [0, 0, 0])")) {
        EXPECT_NEAR(x.z(), -0.8, 1e-6);
        EXPECT_LE(std::abs(x.x()), 0.2 + 1e-6);
    }
}

std::string error_of(const std::string& attachments)
{
    const Scene scene = parse_scene(R"({"toile": 1, "frames": 2, "avatars": [
        {"name": "a", "sphere": {"radius": 0.1}, "translate": [-0.3, 1, 0]},
        {"name": "b", "sphere": {"radius": 0.1}, "translate": [0.3, 1, 0]}], "cloths": [{"name": "c",
        "rectangle": {"size": [0.4, 0.4], "resolution": 0.1}, "translate": [0, 0.7, 0]}], "attachments": [)" +
                                        attachments + "]}",
                                    "owners.json");
    try {
        const World world(scene);
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return {};
}

TEST(Attachments, RefuseAVertexOfTwoOwners)
{
    const auto middle = [](const std::string& to) {
        return R"({"cloth": "c", "select": {"nearest": [[0, 0.7, 0]]}, )" + to + "}";
    };
    const std::string a = middle(R"("to": "a")"), b = middle(R"("to": "b")"),
                      still = middle(R"("exact": true)");
    EXPECT_EQ(error_of(a + ", " + b).substr(0, 44), "owners.json: attachments[1]: selects vertex ");
    EXPECT_NE(error_of(a + ", " + b).find("attachments[0] holds already"), std::string::npos);
    EXPECT_NE(error_of(still + ", " + b), "");
    EXPECT_NE(error_of(still + ", " + middle(R"("keyframes": [{"time": 0}])")), "");
    EXPECT_EQ(error_of(still + ", " + still), "") << "corners of two edges that are held";
    EXPECT_EQ(error_of(a), "");
}

} // namespace
} // namespace toile::test
