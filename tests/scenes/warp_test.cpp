#include <gtest/gtest.h>

#include "scenes/format/read_scene.h"
#include "scenes/world/scene_cloth.h"

/// Which way the warp runs.
namespace toile::test {

using namespace scenes;

namespace {

garment::RestShape rest_of(const std::string& keys)
{
    const Scene scene =
        parse_scene(R"({"toile": 1, "frames": 1, "cloths": [{"name": "c", )" + keys + "}]}", "warp.json");
    return *SceneCloth(scene, scene.cloths[0], {}, {}).rest_shape();
}

void expect_equal(const garment::RestShape& a, const garment::RestShape& b)
{
    ASSERT_EQ(a.triangles.size(), b.triangles.size());
    for (size_t t = 0; t < a.edges.size(); ++t)
        EXPECT_LT((a.edges[t] - b.edges[t]).norm(), 1e-12);
}

TEST(Warp, IsTheXOfFlatClothHoweverItIsPlaced)
{
    const std::string kShape = R"("rectangle": {"size": [0.4, 0.08], "resolution": 0.02})";
    const garment::RestShape flat = rest_of(kShape);
    EXPECT_NEAR(flat.edges[0].row(0).cwiseAbs().maxCoeff(), 0.02, 1e-9);
    for (const char* turn : {"[0, 90, 0]", "[90, 0, 0]", "[0, 0, 90]", "[12, 37, 8]"}) {
        SCOPED_TRACE(turn);
        expect_equal(flat, rest_of(kShape + R"(, "rotate_deg": )" + turn));
    }
}

TEST(Warp, IsTurnedByTheGrain)
{
    const std::string kShape =
        R"("rectangle": {"size": [0.4, 0.4], "resolution": 0.02}, "rotate_deg": [0, 50, 0])";
    const garment::RestShape along = rest_of(kShape), across = rest_of(kShape + R"(, "grain_deg": 90)");
    for (size_t t = 0; t < along.edges.size(); ++t)
        for (int k = 0; k < 2; ++k)
            EXPECT_NEAR(std::abs(along.edges[t](0, k)), std::abs(across.edges[t](1, k)), 1e-12);
}

TEST(Warp, IsTheVerticalOfGarmentsAsTheyStand)
{
    const garment::RestShape standing =
        rest_of(R"("skirt": {"waist_radius": 0.1, "hem_radius": 0.1, "length": 0.4, "resolution": 0.05})");
    for (const Mat2& edges : standing.edges) {
        // Rows of vertices around a tube lie across the warp.
        const double least =
            std::min({std::abs(edges(0, 0)), std::abs(edges(0, 1)), std::abs(edges(0, 1) - edges(0, 0))});
        EXPECT_LT(least, 0.005);
    }
}

} // namespace
} // namespace toile::test
