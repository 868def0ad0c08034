#include <gtest/gtest.h>

#include <cmath>

#include "collision/check/penetration.h"
#include "scenes/colliders/scene_body.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"

namespace toile::test {

using namespace collision;
using namespace scenes;

namespace {

/// Sheet of 1 m whose triangles (25 cm) are larger than the solid, dropped on it from 5 cm above. The solid's
/// highest point is the origin.
Scene coarse_sheet_on(const std::string& solid, int threads = 0)
{
    return parse_scene(R"({"toile": 1, "frames": 45, "solver": {"substeps": 8, "threads": )" +
                           std::to_string(threads) + R"(}, "avatars": [{"name": "solid", )" + solid +
                           R"(}, {"name": "floor", "plane": {}, "translate": [0, -0.5, 0]}],
        "cloths": [{"name": "sheet", "rectangle": {"size": [1, 1], "resolution": 0.25},
            "translate": [0.07, 0.05, 0.04]}]})",
                       "coarse.json");
}

/// Measurements of a run.
struct Outcome {
    double deepest = 0.0; ///< [m] max depth of any point of the cloth in a solid, over all frames
    double highest = 0.0; ///< [m] max height of the cloth in the last frame
    std::vector<Vec3> positions;
};

Outcome run(const Scene& scene)
{
    World world(scene);
    std::vector<SceneBody> bodies = make_bodies(scene);
    Outcome outcome;
    while (world.frame() + 1 < world.frame_count()) {
        EXPECT_NE(world.advance_frame().status, StepReport::Status::NonFinite);
        const ClothState& sheet = world.cloths()[0];
        for (SceneBody& body : bodies) {
            body.advance_to(world.frame() * scene.frame_duration());
            for (const Triangle& t : sheet.triangles)
                outcome.deepest =
                    std::max(outcome.deepest,
                             penetration_of_triangle(*body.shape(), body.pose(), sheet.positions[t[0]],
                                                     sheet.positions[t[1]], sheet.positions[t[2]]));
        }
    }
    outcome.positions = world.cloths()[0].positions;
    outcome.highest = -1.0;
    for (const Vec3& x : outcome.positions)
        outcome.highest = std::max(outcome.highest, x.y());
    return outcome;
}

const std::string kBall = R"("sphere": {"radius": 0.03}, "translate": [0, -0.03, 0])";
const std::string kCapsule =
    R"("capsule": {"radius": 0.02, "length": 0.16}, "translate": [0, -0.02, 0], "rotate_deg": [0, 20, 90])";
const std::string kUprightCapsule =
    R"("capsule": {"radius": 0.02, "length": 0.16}, "translate": [0, -0.1, 0])";
const std::string kBox = R"("box": {"size": [0.1, 0.06, 0.14]}, "translate": [0, -0.03, 0])";
const std::string kBoxOnItsEdge =
    R"("box": {"size": [0.1, 0.1, 0.5]}, "translate": [0, -0.0707106781, 0], "rotate_deg": [0, 0, 45])";
const std::string kBoxOnItsTip =
    R"("box": {"size": [0.12, 0.12, 0.12]}, "translate": [0, -0.1039230485, 0], "rotate_deg": [45, 0, 35.264389683])";

TEST(CoarseCloth, StaysOutsideOfSolidsSmallerThanItsTriangles)
{
    for (const std::string& solid : {kBall, kCapsule, kUprightCapsule, kBox, kBoxOnItsEdge, kBoxOnItsTip}) {
        const Outcome outcome = run(coarse_sheet_on(solid));
        EXPECT_LT(outcome.deepest, 2e-3) << solid;
    }
}

TEST(CoarseCloth, IsLiftedByASolidThatRises)
{
    for (const std::string& solid : {kBall, kBoxOnItsTip, kBox})
        for (const double speed : {0.5, 2.0}) {
            const std::string keyframes = R"(, "keyframes": [{"time": 0}, {"time": 1, "translate": [0, )" +
                                          std::to_string(speed) + ", 0]}]";
            Scene scene = coarse_sheet_on(solid + keyframes);
            scene.frames = 30;
            // The box's edges pierce single triangles by up to 6 mm, depending on the last bits.
            EXPECT_LT(run(scene).deepest, solid == kBox ? 8e-3 : 2e-3) << solid << " at " << speed << " m/s";
        }
}

TEST(CoarseCloth, GivesTheSameBitsForAnyThreadCountOnABox)
{
    const Outcome one = run(coarse_sheet_on(kBoxOnItsTip, 1));
    const Outcome four = run(coarse_sheet_on(kBoxOnItsTip, 4));
    for (size_t i = 0; i < one.positions.size(); ++i)
        EXPECT_EQ(one.positions[i], four.positions[i]);
}

TEST(CoarseCloth, SearchesFacesAndEdgesOnlyWhereASolidCanPierceThem)
{
    Scene plane_only = coarse_sheet_on(kBall);
    plane_only.avatars.erase(plane_only.avatars.begin());
    World world(plane_only);
    while (world.frame() < 20)
        world.advance_frame();
    EXPECT_GT(world.stages().calls("collision/shape"), 0);
    for (const char* stage : {"collision/shape_distance", "collision/shape_faces", "collision/shape_edges"})
        EXPECT_EQ(world.stages().calls(stage), 0) << stage;
}

} // namespace
} // namespace toile::test
