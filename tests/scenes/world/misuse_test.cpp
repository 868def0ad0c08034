#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <thread>

#include "core/base/error.h"
#include "scenes/format/read_scene.h"
#include "scenes/format/validate.h"
#include "scenes/world/world.h"

/// Programs make mistakes that scene files cannot.
namespace toile::test {

using namespace scenes;

namespace {

Scene two_sheets()
{
    return parse_scene(R"({"toile": 1, "frames": 5, "settle": 0.1, "avatars": [{"name": "ball", "sphere":
        {"radius": 0.2}}], "solver": {"threads": 1}, "cloths": [
        {"name": "c", "rectangle": {"size": [0.6, 0.6], "resolution": 0.1}, "translate": [0, 0.25, 0]},
        {"name": "d", "rectangle": {"size": [0.3, 0.3], "resolution": 0.1}, "translate": [0, 0.35, 0]}]})",
                       "sheets.json");
}

/// Message of the InvalidUse that a call throws; empty if it throws none.
std::string refusal(const std::function<void()>& call)
{
    try {
        call();
    } catch (const InvalidUse& error) {
        return error.what();
    }
    return {};
}

TEST(Misuse, PlacingWrongNumbersOfVerticesIsRefused)
{
    World world(two_sheets());
    const std::vector<Vec3> before = world.cloths()[1].positions;
    const int count = int(world.cloths()[0].positions.size());
    for (const int n : {0, 1, count - 3, count + 5, 200000})
        EXPECT_NE(refusal([&] {
                      world.place(0, std::vector<Vec3>(size_t(n), Vec3::Zero()));
                  }).find("has " + std::to_string(n) + " positions"),
                  std::string::npos);
    const std::vector<Vec3> start = world.cloths()[0].positions;
    for (const int cloth : {-1, 2, 9})
        EXPECT_NE(refusal([&] { world.place(cloth, start); }).find("has 2 cloths"), std::string::npos);
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e200, -1e6}) {
        std::vector<Vec3> x = start;
        x[7].z() = bad;
        EXPECT_THROW(world.place(0, x), InvalidInput);
    }
    EXPECT_EQ(world.cloths()[1].positions, before);
    world.place(0, start);
    EXPECT_NE(world.advance_frame().status, StepReport::Status::NonFinite);
}

TEST(Misuse, AWorldThatWasMovedFromIsRefused)
{
    World world(two_sheets());
    World other(std::move(world));
    other.advance_frame();
    // NOLINTBEGIN(bugprone-use-after-move): that is the test
    EXPECT_NE(refusal([&] { world.advance_frame(); }).find("moved from"), std::string::npos);
    EXPECT_NE(refusal([&] { static_cast<void>(world.frame()); }).find("moved from"), std::string::npos);
    EXPECT_NE(refusal([&] { static_cast<void>(world.cloths()); }).find("moved from"), std::string::npos);
    EXPECT_NE(refusal([&] { static_cast<void>(world.snapshot()); }).find("moved from"), std::string::npos);
    world = World(two_sheets());
    // NOLINTEND(bugprone-use-after-move)
    EXPECT_EQ(refusal([&] { world.advance_frame(); }), "");
}

TEST(Misuse, CallsInWrongOrderAndBeyondAreRefused)
{
    World world(two_sheets());
    world.advance_frame();
    EXPECT_NE(refusal([&] { world.settle(); }).find("sample 0 is past"), std::string::npos);
    EXPECT_NE(refusal([&] { static_cast<void>(world.snapshot()->positions(2)); }).find("2 surfaces"),
              std::string::npos);
    EXPECT_NE(refusal([&] { static_cast<void>(world.snapshot()->positions(-1)); }), "");
}

TEST(Misuse, CallsAtOnceAreRefused)
{
    Scene scene = two_sheets();
    scene.solver.method = scene::SolverMethod::Quadrature;
    scene.solver.outer = OuterMethod::LocalGlobal;
    WorldOptions options;
    World* called = nullptr;
    std::string said;
    options.building = [&](const std::string&, double) {
        std::jthread([&] { said = refusal([&] { called->advance_frame(); }); }).join();
        return true;
    };
    World world(scene, options);
    called = &world;
    world.prepare();
    EXPECT_NE(said.find("World::advance_frame: another call of this World is running"), std::string::npos);
    EXPECT_EQ(refusal([&] { world.advance_frame(); }), "");
}

TEST(Misuse, AWorldThatFailedStaysFailed)
{
    Scene scene = two_sheets();
    scene.solver.method = scene::SolverMethod::Quadrature;
    scene.solver.outer = OuterMethod::LocalGlobal;
    WorldOptions options;
    options.building = [](const std::string&, double) { return false; };
    World world(scene, options);
    EXPECT_THROW(world.prepare(), Cancelled); // nothing has begun: may be called again
    EXPECT_THROW(world.prepare(), Cancelled);
    EXPECT_THROW(world.advance_frame(), Cancelled);
    EXPECT_NE(refusal([&] { world.advance_frame(); }).find("has failed"), std::string::npos);
    EXPECT_NE(refusal([&] { world.settle(); }).find("has failed"), std::string::npos);
    EXPECT_EQ(world.cloths().size(), 2);
}

/// A scene that a program has changed gets the checks of a file.
TEST(Misuse, InvalidScenesAreRefused)
{
    const auto refused = [](const std::function<void(Scene&)>& change) {
        Scene scene = two_sheets();
        change(scene);
        try {
            const World world(scene);
        } catch (const InvalidInput& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const double nan = std::nan("");
    EXPECT_EQ(refused([](Scene&) {}), "");
    EXPECT_NE(refused([](Scene& s) { s.cloths.clear(); }).find("cloths: nothing to simulate"),
              std::string::npos);
    const std::vector<std::pair<std::string, std::function<void(Scene&)>>> changes{
        {"sheets.json: frames: -4 is out of range; give a number from 1", [](Scene& s) { s.frames = -4; }},
        {"fps", [](Scene& s) { s.fps = 0.0; }},
        {"gravity[1]", [&](Scene& s) { s.gravity.y() = nan; }},
        {"solver.substeps", [](Scene& s) { s.solver.substeps = -3; }},
        {"solver.tolerance", [&](Scene& s) { s.solver.tolerance = nan; }},
        {"solver.threads", [](Scene& s) { s.solver.threads = -4; }},
        {"solver.method", [](Scene& s) { s.solver.method = scene::SolverMethod(77); }},
        {"cloths[0].fabric", [](Scene& s) { s.cloths[0].fabric = "nope"; }},
        {"cloths[0].thickness", [&](Scene& s) { s.cloths[0].thickness = nan; }},
        {"cloths[1].rectangle.resolution",
         [](Scene& s) { std::get<scene::Rectangle>(s.cloths[1].shape).resolution = 0.0; }},
        {"cloths[0].rectangle.size[0]",
         [&](Scene& s) { std::get<scene::Rectangle>(s.cloths[0].shape).size.x() = nan; }},
        {"avatars[0].sphere.radius",
         [](Scene& s) { std::get<scene::Sphere>(s.avatars[0].shape).radius = -1.0; }},
        {"attachments[0].cloth",
         [](Scene& s) {
             s.attachments.push_back({"nope", {std::vector<int>{0}}, "fixed", {}, {}, {}, {}});
         }},
        {"attachments[0].to",
         [](Scene& s) {
             s.attachments.push_back({"c", {std::vector<int>{0}}, "nobody", {}, {}, {}, {}});
         }},
        {"attachments[0].select.vertices[0]",
         [](Scene& s) {
             s.attachments.push_back({"c", {std::vector<int>{-5}}, "fixed", {}, {}, {}, {}});
         }},
        {"vertex 99999 is out of range",
         [](Scene& s) {
             s.attachments.push_back({"c", {std::vector<int>{99999}}, "fixed", {}, {}, {}, {}});
         }},
        {"fabrics.odd.bend.warp", [&](Scene& s) { s.fabrics["odd"].bend.warp = nan; }},
        {"render.ground", [&](Scene& s) { s.render.ground = nan; }},
        {"/nonexistent.obj",
         [](Scene& s) { s.avatars[0].shape = std::filesystem::path("/nonexistent.obj"); }},
    };
    for (const auto& [says, change] : changes)
        EXPECT_NE(refused(change).find(says), std::string::npos) << says << ": " << refused(change);
    EXPECT_THROW(World{Scene()}, InvalidInput);
}

} // namespace
} // namespace toile::test
