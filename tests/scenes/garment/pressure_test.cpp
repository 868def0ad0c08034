#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "core/base/error.h"
#include "core/mesh/obj.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/backend.h"
#include "scenes/world/world.h"
#include "tests/support/temporary_folder.h"

/// Cloth under pressure.
namespace toile::test {

using namespace scenes;

namespace {

constexpr double kRadius = 0.1; // [m] of the balloon at rest

/// An icosahedron, split and moved onto the sphere.
TriangleMesh sphere()
{
    const double g = 0.5 * (1.0 + std::sqrt(5.0));
    TriangleMesh mesh{{Vec3(-1, g, 0), Vec3(1, g, 0), Vec3(-1, -g, 0), Vec3(1, -g, 0), Vec3(0, -1, g),
                       Vec3(0, 1, g), Vec3(0, -1, -g), Vec3(0, 1, -g), Vec3(g, 0, -1), Vec3(g, 0, 1),
                       Vec3(-g, 0, -1), Vec3(-g, 0, 1)},
                      {}};
    const int corners[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (const auto& t : corners)
        mesh.triangles.emplace_back(t[0], t[1], t[2]);
    mesh = subdivide(mesh, 3);
    for (Vec3& p : mesh.positions)
        p *= kRadius / p.norm();
    return mesh;
}

double area_of(const TriangleMesh& mesh)
{
    double area = 0.0;
    for (const Triangle& t : mesh.triangles)
        area += 0.5 * (mesh.positions[t[1]] - mesh.positions[t[0]])
                          .cross(mesh.positions[t[2]] - mesh.positions[t[0]])
                          .norm();
    return area;
}

double volume_of(const TriangleMesh& mesh)
{
    double volume = 0.0;
    for (const Triangle& t : mesh.triangles)
        volume += mesh.positions[t[0]].dot(mesh.positions[t[1]].cross(mesh.positions[t[2]])) / 6.0;
    return volume;
}

std::string scene_text(const std::string& cloth, const std::string& more = "")
{
    return R"({"toile": 1, "frames": 61, "gravity": [0, 0, 0], "air": {"density": 0},
        "fabrics": {"rubber": {"areal_density": 0.2, "stretch": {"warp": 1000, "weft": 1000}, "shear": 400,
                    "bend": {"warp": 0, "weft": 0}, "strain_limit": 3, "damping": 0}},
        "cloths": [{"name": "skin", "fabric": "rubber", )" +
           cloth + "}]" + more + "}";
}

class PressureInScenes : public ::testing::Test {
protected:
    PressureInScenes() { write_obj(folder_.path() / "ball.obj", sphere()); }

    Scene ball(const std::string& pressure, const std::string& more = "") const
    {
        return parse_scene(scene_text(R"("file": "ball.obj")" + pressure, more),
                           folder_.path() / "ball.json");
    }

    std::vector<Vec3> after(const Scene& scene, int frames) const
    {
        World world(scene);
        while (world.frame() < frames)
            EXPECT_NE(world.advance_frame().status, StepReport::Status::NonFinite);
        return world.cloths()[0].positions;
    }

    TemporaryFolder folder_;
};

const std::string kQuiet = R"(, "solver": {"integrator": "implicit-euler", "velocity_tolerance": 1e-4})";

} // namespace

/// The membrane's tension per current width is k (s - 1) / s at a stretch s, and p = 2 tension / radius.
/// On the mesh, 3 V / A is in the place of the radius.
TEST_F(PressureInScenes, BalloonHasTheRadiusOfItsTension)
{
    const TriangleMesh rest = sphere();
    const double radius = 3.0 * volume_of(rest) / area_of(rest);
    for (const double stretch : {1.02, 1.1}) {
        const double pascal = 2.0 * 1000.0 * (stretch - 1.0) / (stretch * stretch * radius);
        TriangleMesh balloon = rest;
        balloon.positions = after(ball(R"(, "pressure": )" + std::to_string(pascal), kQuiet), 60);
        EXPECT_NEAR(std::cbrt(volume_of(balloon) / volume_of(rest)), stretch, 0.02 * (stretch - 1.0));
        Vec3 centre = Vec3::Zero();
        for (const Vec3& p : balloon.positions)
            centre += p / double(balloon.positions.size());
        EXPECT_LT(centre.norm(), 1e-6) << "it moved itself";
    }
}

TEST_F(PressureInScenes, RisesOverItsRamp)
{
    const scene::Pressure pressure{80.0, 2.0};
    EXPECT_EQ(pressure.at(-1.0), 0.0);
    EXPECT_EQ(pressure.at(0.5), 20.0);
    EXPECT_EQ(pressure.at(2.0), 80.0);
    EXPECT_EQ(pressure.at(9.0), 80.0);
    EXPECT_EQ((scene::Pressure{80.0, 0.0}.at(-1.0)), 80.0);

    // Slowly enough, it is in equilibrium at all times: at half of the ramp under half of the pressure.
    const TriangleMesh rest = sphere();
    const auto size_after = [&](const std::string& keys, int frames) {
        TriangleMesh now = rest;
        now.positions = after(ball(keys, kQuiet), frames);
        return std::cbrt(volume_of(now) / volume_of(rest)) - 1.0;
    };
    const double half = size_after(R"(, "pressure": 300)", 45);
    EXPECT_GT(half, 0.01);
    EXPECT_NEAR(size_after(R"(, "pressure": {"pa": 600, "ramp_s": 3})", 45), half, 0.02 * half);
}

/// All of a free sheet accelerates by p over its areal density, along its normals.
TEST_F(PressureInScenes, AcceleratesAFlatSheetEvenly)
{
    const Scene scene = parse_scene(
        scene_text(R"("disc": {"radius": 0.2, "resolution": 0.04}, "pressure": 0.5)"), "sail.json");
    const std::vector<Vec3> start = World(scene).cloths()[0].positions, end = after(scene, 30);
    const double expected = 0.5 * (0.5 / 0.2) * 1.0 * 1.0; // [m] in a second
    for (size_t v = 0; v < start.size(); ++v) {
        EXPECT_NEAR(end[v].y() - start[v].y(), expected, 0.02 * expected);
        EXPECT_NEAR((end[v] - start[v]).x(), 0.0, 1e-4);
    }
}

TEST_F(PressureInScenes, CostsNothingWhereThereIsNone)
{
    World plain(ball("")), zero(ball(R"(, "pressure": 0)"));
    for (World* world : {&plain, &zero}) {
        (void)world->advance_frame();
        EXPECT_EQ(world->stages().calls("garment/pressure"), 0);
    }
    EXPECT_EQ(plain.cloths()[0].positions, zero.cloths()[0].positions);
    World pressed(ball(R"(, "pressure": 10)"));
    (void)pressed.advance_frame();
    EXPECT_GT(pressed.stages().calls("garment/pressure"), 0);
}

TEST_F(PressureInScenes, WarnsOfNormalsThatPointInwards)
{
    TriangleMesh inside_out = sphere();
    for (Triangle& t : inside_out.triangles)
        std::swap(t[0], t[1]);
    write_obj(folder_.path() / "inside_out.obj", inside_out);
    const auto warnings_of = [&](const std::string& cloth) {
        std::string text;
        WorldOptions options;
        options.warn = [&](const std::string& warning) { text += warning; };
        const World world(parse_scene(scene_text(cloth), folder_.path() / "ball.json"), options);
        return text;
    };
    EXPECT_NE(warnings_of(R"("file": "inside_out.obj", "pressure": 10)").find("normals point inwards"),
              std::string::npos);
    EXPECT_EQ(warnings_of(R"("file": "inside_out.obj", "pressure": -10)"), "");
    EXPECT_EQ(warnings_of(R"("file": "ball.obj", "pressure": 10)"), "");
}

TEST_F(PressureInScenes, IsOnTheCpuOnly)
{
    EXPECT_EQ(why_not_on_gpu(ball("")), "");
    EXPECT_EQ(why_not_on_gpu(ball(R"(, "pressure": 10)")), "pressure on cloth runs on the CPU only");
}

TEST_F(PressureInScenes, RefusesWhatHasNoMeaning)
{
    const auto refusal_of = [&](const std::string& pressure, const std::string& more = "") {
        try {
            (void)ball(R"(, "pressure": )" + pressure, more);
        } catch (const InvalidInput& error) {
            return std::string(error.what()).substr((folder_.path() / "ball.json").string().size());
        }
        return std::string();
    };
    const std::string at = ": cloths[0].pressure";
    EXPECT_EQ(refusal_of("200000"), at + ": 200000 is out of range; give a number from -100000 to 100000 Pa");
    EXPECT_EQ(refusal_of("\"high\""),
              at + ": \"high\" is neither a number nor an object; give a number from -100000 to 100000 Pa");
    EXPECT_EQ(refusal_of(R"({"ramp_s": 1})"), at + ": the key \"pa\" is missing; add it");
    EXPECT_EQ(refusal_of(R"({"pa": 1, "ramp": 1})"), at + ".ramp: unknown key; did you mean \"ramp_s\"?");
    EXPECT_EQ(refusal_of(R"({"pa": 1, "ramp_s": -1})"),
              at + ".ramp_s: -1 is out of range; give a number from 0 to 86400 s");
    EXPECT_EQ(refusal_of("10", R"(, "contact": {"self": false}, "solver": {"method": "xpbd"})"),
              at + ": is unknown to solver.method \"xpbd\"; choose another method, or remove it");
}

} // namespace toile::test
