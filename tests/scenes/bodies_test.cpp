#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "collision/check/find_crossings.h"
#include "collision/check/penetration.h"
#include "core/mesh/obj.h"
#include "garment/energy/strain_limit/strain_limit.h"
#include "scenes/colliders/scene_body.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"
#include "tests/collision/shapes_for_tests.h"
#include "tests/support/temporary_folder.h"

/// Cloth never crosses a body: fast, thin, sharp and open ones.
namespace toile::test {

using namespace collision;
using namespace scenes;

namespace {

/// What a run has come to.
struct Outcome {
    int crossings = 0;   ///< with meshes, sum over frames
    double depth = 0.0;  ///< [m] in shapes, max over frames
    double strain = 0.0; ///< [-] max over frames
    StepReport::Status worst = StepReport::Status::Converged;
    std::vector<Vec3> start, x; ///< in the first and the last frame [m]
};

Outcome run(const std::string& text, const std::string& source = "bodies.json")
{
    const Scene scene = parse_scene(text, source);
    World world(scene);
    std::vector<SceneBody> bodies = make_bodies(scene);
    const ClothState& cloth = world.cloths()[0];
    Outcome outcome;
    outcome.start = cloth.positions;
    while (world.frame() + 1 < world.frame_count()) {
        const StepReport report = world.advance_frame();
        outcome.worst = std::max(outcome.worst, report.status);
        outcome.strain = std::max(outcome.strain, report.max_strain);
        for (SceneBody& body : bodies) {
            body.advance_to(world.frame() * scene.frame_duration());
            if (!body.shape()) {
                const TriangleMesh& surface = body.contact_surface();
                outcome.crossings +=
                    int(find_crossings(cloth.triangles, cloth.positions, surface.triangles, surface.positions)
                            .size());
                continue;
            }
            for (const Triangle& t : cloth.triangles)
                outcome.depth = std::max(
                    outcome.depth, penetration_of_triangle(*body.shape(), body.pose(), cloth.positions[t[0]],
                                                           cloth.positions[t[1]], cloth.positions[t[2]]));
        }
    }
    outcome.x = cloth.positions;
    return outcome;
}

/// An arm that goes through 60 cm at `speed` [m/s], and a curtain in its way.
std::string curtain(const std::string& arm, double speed)
{
    return R"({"toile": 1, "frames": 20, "avatars": [{"name": "arm", "rotate_deg": [0, 0, 90],
        "translate": [0, 0.6, 0.3], "keyframes": [{"time": 0.3}, {"time": )" +
           std::to_string(0.3 + 0.6 / speed) + R"(, "translate": [0, 0, -0.6]}], )" + arm + R"(}],
        "cloths": [{"name": "curtain", "rectangle": {"size": [0.8, 1], "resolution": 0.04},
        "rotate_deg": [90, 0, 0], "translate": [0, 0.6, 0]}], "attachments": [{"cloth": "curtain",
        "select": {"box": {"lower": [-1, 1.08, -1], "upper": [1, 1.2, 1]}}}]})";
}

/// Columns of a curtain that the arm has left behind: seen from the top, they come to its height behind it.
int left_behind(const Outcome& outcome)
{
    std::map<int, std::vector<std::pair<double, int>>> columns; // by x [mm]: height and vertex
    for (int v = 0; v < int(outcome.start.size()); ++v)
        columns[int(std::lround(1e3 * outcome.start[v].x()))].emplace_back(-outcome.start[v].y(), v);
    int behind = 0;
    for (auto& [at, column] : columns) {
        std::sort(column.begin(), column.end());
        const auto first = std::find_if(column.begin(), column.end(),
                                        [&](const auto& of) { return outcome.x[of.second].y() < 0.6; });
        behind += first != column.end() && outcome.x[first->second].z() > -0.3 ? 1 : 0;
    }
    return behind;
}

TEST(Bodies, CarryACurtainAlong)
{
    for (const double speed : {5.0, 15.0}) {
        const Outcome outcome = run(curtain(R"("capsule": {"radius": 0.04, "length": 0.8})", speed));
        EXPECT_LT(outcome.depth, 1e-3) << speed << " m/s";
        EXPECT_EQ(left_behind(outcome), 0) << speed << " m/s";
        EXPECT_LT(outcome.strain, 0.06 + garment::kStrainMargin) << speed << " m/s";
    }
}

TEST(Bodies, SayThatTheyWereTooFast)
{
    const Outcome outcome = run(curtain(R"("capsule": {"radius": 0.04, "length": 0.8})", 40.0));
    EXPECT_GE(outcome.worst, StepReport::Status::Yielded);
}

TEST(Bodies, SayThatTheyHaveJumpedThroughCloth)
{
    const Outcome outcome = run(curtain(R"("capsule": {"radius": 0.04, "length": 0.8})", 500.0));
    EXPECT_EQ(outcome.worst, StepReport::Status::Stuck);
}

TEST(Bodies, HoldClothOnBoxesOfAnyThickness)
{
    for (const double thickness : {0.02, 0.05, 0.1}) {
        const Outcome outcome = run(R"({"toile": 1, "frames": 30, "avatars": [{"name": "box", "box":
            {"size": [0.3, )" + std::to_string(thickness) +
                                    R"(, 0.3]}, "translate": [0, )" + std::to_string(0.5 - 0.5 * thickness) +
                                    R"(, 0]}], "cloths": [{"name": "c", "rectangle": {"size": [0.5, 0.5],
            "resolution": 0.03}, "translate": [0.01, 0.53, 0], "rotate_deg": [0, 10, 0], "fabric": "silk"}]})");
        EXPECT_LT(outcome.depth, 1e-3) << thickness;
        EXPECT_LT(outcome.strain, 0.05 + garment::kStrainMargin) << thickness;
        const double lowest =
            std::min_element(outcome.x.begin(), outcome.x.end(), [](const Vec3& a, const Vec3& b) {
                return a.y() < b.y();
            })->y();
        EXPECT_GT(lowest, 0.2) << thickness << ": it has slid off";
    }
}

/// Writes a square plate of two triangles at height 0.
void write_plate(const TemporaryFolder& folder, bool faces_up)
{
    folder.write("plate.obj", std::string("v -0.2 0 -0.2\nv 0.2 0 -0.2\nv 0.2 0 0.2\nv -0.2 0 0.2\n") +
                                  (faces_up ? "f 1 4 3\nf 1 3 2\n" : "f 1 3 4\nf 1 2 3\n"));
}

TEST(Bodies, HaveTwoSidesWhereTheyAreOpen)
{
    for (const bool faces_up : {true, false}) {
        const TemporaryFolder folder;
        write_plate(folder, faces_up);
        const Outcome outcome = run(R"({"toile": 1, "frames": 20, "avatars": [{"name": "plate",
            "file": "plate.obj", "translate": [0, 0.5, 0]}], "cloths": [{"name": "c", "rectangle":
            {"size": [0.3, 0.3], "resolution": 0.04}, "translate": [0, 0.6, 0], "fabric": "cotton"}]})",
                                    folder.path() / "scene.json");
        EXPECT_EQ(outcome.crossings, 0) << faces_up;
        for (const Vec3& x : outcome.x)
            EXPECT_GT(x.y(), 0.5) << faces_up;
    }
}

TEST(Bodies, HoldAtTheirCorners)
{
    const TemporaryFolder folder;
    folder.write("cube.obj", "v -0.2 -0.2 -0.2\nv 0.2 -0.2 -0.2\nv 0.2 0.2 -0.2\nv -0.2 0.2 -0.2\n"
                             "v -0.2 -0.2 0.2\nv 0.2 -0.2 0.2\nv 0.2 0.2 0.2\nv -0.2 0.2 0.2\n"
                             "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\nf 1 5 8 4\nf 2 3 7 6\n");
    const Outcome outcome = run(R"({"toile": 1, "frames": 12, "avatars": [{"name": "box", "file": "cube.obj",
        "translate": [0, 0.2, 0]}], "cloths": [{"name": "c", "rectangle": {"size": [1, 1], "resolution": 0.05},
        "translate": [0.03, 0.46, 0.02], "rotate_deg": [0, 17, 0], "fabric": "cotton"}]})",
                                folder.path() / "scene.json");
    EXPECT_EQ(outcome.crossings, 0);
    EXPECT_LT(outcome.strain, 0.06 + garment::kStrainMargin);
}

TEST(Bodies, AreTurnedWhereTheyAreInsideOut)
{
    const TemporaryFolder folder;
    TriangleMesh ball = testing::sphere_mesh(Vec3::Zero(), 0.2, 3);
    for (Triangle& t : ball.triangles)
        std::swap(t[1], t[2]);
    write_obj(folder.path() / "ball.obj", ball);
    const std::string text = R"({"toile": 1, "frames": 16, "avatars": [{"name": "ball", "file": "ball.obj"}],
        "cloths": [{"name": "c", "rectangle": {"size": [0.4, 0.4], "resolution": 0.04},
        "translate": [0, 0.25, 0], "fabric": "cotton"}]})";
    const Outcome outcome = run(text, folder.path() / "scene.json");
    EXPECT_EQ(outcome.crossings, 0);
    EXPECT_LT(outcome.strain, 0.06 + garment::kStrainMargin);
    for (const Vec3& x : outcome.x)
        EXPECT_GT(x.norm(), 0.195);

    std::vector<std::string> warnings;
    WorldOptions options;
    options.warn = [&](const std::string& warning) { warnings.push_back(warning); };
    const World world(parse_scene(text, folder.path() / "scene.json"), options);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("turned " + std::to_string(ball.triangle_count()) + " of"), std::string::npos)
        << warnings[0];
}

/// Two cloths in one place, on a ball: the higher layer is outside, and stays there.
TEST(Bodies, WearLayersInTheirOrder)
{
    const Scene scene = parse_scene(R"({"toile": 1, "frames": 12, "avatars": [{"name": "ball", "sphere":
        {"radius": 0.2}}], "cloths": [{"name": "coat", "layer": 1, "rectangle": {"size": [0.5, 0.5],
        "resolution": 0.04}, "translate": [0, 0.21, 0]}, {"name": "shirt", "rectangle": {"size": [0.5, 0.5],
        "resolution": 0.04}, "translate": [0, 0.21, 0]}]})",
                                    "layers.json");
    World world(scene);
    const ClothState &coat = world.cloths()[0], &shirt = world.cloths()[1];
    const auto mean_distance = [](const ClothState& cloth) {
        double sum = 0.0;
        for (const Vec3& x : cloth.positions)
            sum += x.norm();
        return sum / double(cloth.positions.size());
    };
    for (; world.frame() + 1 < world.frame_count(); world.advance_frame()) {
        EXPECT_TRUE(find_crossings(coat.triangles, coat.positions, shirt.triangles, shirt.positions).empty());
        EXPECT_GT(mean_distance(coat), mean_distance(shirt)) << "frame " << world.frame();
    }
}

/// Report of the last frame.
StepReport run_to_end(World& world)
{
    StepReport report;
    while (world.frame() + 1 < world.frame_count())
        report = world.advance_frame();
    return report;
}

/// Vertices that are held exactly, and moved into a box, stay out of it, and the run says so.
TEST(Bodies, KeepExactlyHeldVerticesOut)
{
    const Scene scene = parse_scene(R"({"toile": 1, "frames": 12, "avatars": [{"name": "box", "box":
        {"size": [0.4, 0.2, 0.4]}}], "cloths": [{"name": "c", "rectangle": {"size": [0.3, 0.3],
        "resolution": 0.03}, "translate": [0, 0.15, 0], "fabric": "cotton"}], "attachments": [{"cloth": "c",
        "select": {"box": {"lower": [-1, 0, -0.16], "upper": [1, 1, -0.14]}}, "keyframes": [{"time": 0},
        {"time": 0.2, "translate": [0, -0.1, 0]}]}]})",
                                    "held.json");
    World world(scene);
    const StepReport report = run_to_end(world);
    EXPECT_GT(report.displaced.count, 3);
    EXPECT_NE(report.displaced.place.find("of \"c\""), std::string::npos) << report.displaced.place;
    EXPECT_GE(report.status, StepReport::Status::Yielded);
    for (const Vec3& x : world.cloths()[0].positions)
        EXPECT_GT(x.y(), 0.1);
}

/// Two held corners of a triangle that part stretch what is between them: their own strain is told apart.
TEST(Bodies, TellTheStrainOfWhatIsHeld)
{
    const Scene scene = parse_scene(R"({"toile": 1, "frames": 8, "cloths": [{"name": "c", "rectangle":
        {"size": [0.2, 0.2], "resolution": 0.02}, "fabric": "cotton"}], "attachments": [
        {"cloth": "c", "select": {"box": {"lower": [-0.2, -1, -1], "upper": [0.001, 1, 1]}}},
        {"cloth": "c", "select": {"box": {"lower": [0.019, -1, -1], "upper": [0.2, 1, 1]}},
         "keyframes": [{"time": 0}, {"time": 0.1, "translate": [0.006, 0, 0]}]}]})",
                                    "pulled.json");
    World world(scene);
    const StepReport report = run_to_end(world);
    EXPECT_GT(report.pulled.count, 5);
    const std::vector<unsigned char> attached = world.cloths()[0].attached(0.1);
    EXPECT_EQ(std::count(attached.begin(), attached.end(), 0), 0);
    EXPECT_NE(report.pulled.place.find("which is attached"), std::string::npos) << report.pulled.place;
    EXPECT_EQ(report.yielded.count, 0);
}

/// Springs to a body by default; exactly where that is asked for.
TEST(Bodies, AttachBySpringsUnlessAskedToHoldExactly)
{
    const auto stretched = [](const std::string& more) {
        // A band around a ball, held on its whole upper half while the ball sinks away below a plate.
        return run(R"({"toile": 1, "frames": 6, "avatars": [{"name": "ball", "sphere": {"radius": 0.2},
            "keyframes": [{"time": 0}, {"time": 0.15, "translate": [0, -0.03, 0]}]}],
            "cloths": [{"name": "c", "rectangle": {"size": [0.3, 0.3], "resolution": 0.03},
            "translate": [0, 0.205, 0], "fabric": "cotton"}],
            "attachments": [{"cloth": "c", "select": {"box": {"lower": [-0.05, 0, -0.05],
            "upper": [0.05, 1, 0.05]}}, "to": "ball")" +
                   more + "}]}");
    };
    for (const char* more : {"", R"(, "exact": true)"}) {
        const Outcome outcome = stretched(more);
        EXPECT_LT(outcome.depth, 1e-3) << more;
        double nearest = 1.0;
        for (const Vec3& x : outcome.x)
            nearest = std::min(nearest, (x - Vec3(0, 0.17, 0)).norm());
        EXPECT_LT(nearest, 0.01) << more << ": the middle has gone along";
    }
}

/// Two corners of a heavy cloth on a small ball: 300 N/m each would let it sag by 8 mm.
TEST(Bodies, HoldHeavyClothByFewVertices)
{
    const Outcome outcome = run(R"({"toile": 1, "frames": 60, "avatars": [
        {"name": "left", "sphere": {"radius": 0.02}, "translate": [-0.5, 1, 0]},
        {"name": "right", "sphere": {"radius": 0.02}, "translate": [0.5, 1, 0]}],
        "fabrics": {"heavy": {"base": "denim", "areal_density": 0.5}},
        "cloths": [{"name": "c", "rectangle": {"size": [1, 1], "resolution": 0.1}, "rotate_deg": [90, 0, 0],
        "translate": [0, 0.475, 0], "fabric": "heavy"}],
        "attachments": [{"cloth": "c", "select": {"nearest": [[-0.5, 0.975, 0]]}, "to": "left"},
                        {"cloth": "c", "select": {"nearest": [[0.5, 0.975, 0]]}, "to": "right"}]})");
    double highest = 0.0;
    for (const Vec3& x : outcome.x)
        highest = std::max(highest, x.y());
    EXPECT_NEAR(highest, 0.975, 1e-3);
}

} // namespace
} // namespace toile::test
