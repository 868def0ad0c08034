#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "core/base/error.h"
#include "core/mesh/solid_moments.h"
#include "core/quadrature/tables/table_store.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world_crossings.h"
#include "tests/scenes/soft_bodies/soft_body_test.h"

namespace toile::test {

using namespace scenes;

namespace {

class SoftBodies : public SoftBodyTest {};

double volume_of(const ClothState& surface)
{
    return solid_moments({surface.positions, surface.triangles}, surface.name).volume;
}

TEST_F(SoftBodies, FallFreelyAndUndeformed)
{
    World world = world_of(R"("frames": 11, "cloths": [], "soft_bodies": [)" +
                           block("jelly", R"("young": 1000, "velocity": [1, 2, 0])") + "]");
    const std::vector<Vec3> start = world.surfaces()[0].positions;
    run(world);
    const double t = 10.0 / 30.0;
    const Vec3 moved = Vec3(t, 2.0 * t - 0.5 * 9.81 * t * t, 0.0);
    for (size_t v = 0; v < start.size(); ++v)
        EXPECT_LT((world.surfaces()[0].positions[v] - start[v] - moved).norm(), 2e-3);
    EXPECT_NEAR(volume_of(world.surfaces()[0]), 1e-3, 1e-7);
}

TEST_F(SoftBodies, LandRestAtTheGapAndSleep)
{
    World world = world_of(
        kFloor + R"("frames": 90, "cloths": [], "soft_bodies": [)" +
        block("jelly",
              R"("young": 20000, "damping": 2, "translate": [0, 0.1, 0], "rotate_deg": [20, 0, 30])") +
        "]");
    run(world);
    EXPECT_GT(lowest(world.surfaces()[0].positions), 0.0004);
    EXPECT_LT(lowest(world.surfaces()[0].positions), 0.0025);
    // It lies on a face: compressed by rho g h / 2 E in the mean.
    EXPECT_NEAR(mean(world.surfaces()[0].positions).y(), 0.05, 0.003);
}

/// A block of fine tetrahedra hits another at 40 m/s, 33 cm a step. The collision-free step stops its
/// surface; inner vertices that went on would crush it beyond recovery, at energies far above that of its
/// motion.
TEST_F(SoftBodies, SurviveImpactsInStepsLongerThanThemselves)
{
    write_msh(folder.path() / "fine.msh", make_block(Vec3::Constant(0.1), {7, 7, 7}, 0.1).mesh);
    const auto fine = [](const std::string& name, const std::string& keys) {
        return R"({"name": ")" + name + R"(", "file": "fine.msh", "young": 20000, "density": 300, )" + keys +
               "}";
    };
    World world =
        world_of(kFloor + R"("frames": 6, "solver": {"substeps": 4}, "cloths": [], "soft_bodies": [)" +
                 fine("low", R"("translate": [0, 0.002, 0])") + ", " +
                 fine("high", R"("translate": [0.02, 0.2, 0.01], "velocity": [0, -40, 0])") + "]");
    constexpr double kMotion = 0.5 * 0.3 * 40.0 * 40.0; // [J]
    while (world.frame() + 1 < world.frame_count()) {
        const StepReport report = world.advance_frame();
        ASSERT_LT(report.energy, 0.2 * kMotion) << world.frame(); // 26 J at most
        ASSERT_EQ(crossing_count(world), 0) << world.frame();
    }
    for (const ClothState& surface : world.surfaces())
        EXPECT_NEAR(volume_of(surface), 1e-3, 5e-5) << surface.name;
}

TEST_F(SoftBodies, SqueezeByTheirOwnWeightAsLinearElasticityHasIt)
{
    // Held below without friction or bulging: nu = 0. The top sinks by rho g h^2 / 2 E.
    World world =
        world_of(R"("frames": 60, "cloths": [], "solver": {"velocity_tolerance": 1e-4}, "soft_bodies": [)" +
                 block("jelly", R"("young": 50000, "poisson": 0, "damping": 20)") + R"(],
        "attachments": [{"cloth": "jelly", "select": {"box": {"lower": [-1, -0.001, -1], "upper": [1, 0.001, 1]}}}])");
    run(world);
    double top = 0.0;
    for (const Vec3& p : world.surfaces()[0].positions)
        top = std::max(top, p.y());
    const double sinks = 1000.0 * 9.81 * 0.01 / (2.0 * 50000.0);
    EXPECT_NEAR(0.1 - top, sinks, 0.1 * sinks);
}

TEST_F(SoftBodies, FollowKeyframes)
{
    World world = world_of(R"("frames": 31, "gravity": [0, 0, 0], "cloths": [], "soft_bodies": [)" +
                           block("jelly", R"("damping": 5)") + R"(], "attachments": [
        {"cloth": "jelly", "select": {"box": {"lower": [-1, -1, -1], "upper": [0.001, 1, 1]}}},
        {"cloth": "jelly", "select": {"box": {"lower": [0.099, -1, -1], "upper": [1, 1, 1]}},
         "keyframes": [{"time": 0, "translate": [0, 0, 0]}, {"time": 0.5, "translate": [0.05, 0, 0]}]}])");
    run(world);
    Bounds box = bounds(world.surfaces()[0].positions);
    EXPECT_NEAR(box.upper.x(), 0.15, 1e-6);
    EXPECT_NEAR(box.lower.x(), 0.0, 1e-6);
    double waist = 0.0;
    for (const Vec3& p : world.surfaces()[0].positions)
        if (std::abs(p.x() - 0.075) < 0.02)
            waist = std::max(waist, p.y());
    EXPECT_LT(waist, 0.095); // it narrows
}

TEST_F(SoftBodies, AreHeldByTheNumbersOfTheirFile)
{
    // A tetrahedron with a vertex inside, which the file has first, and an unused one after it.
    std::ofstream(folder.path() / "star.vtk")
        << "# vtk DataFile Version 3.0\nstar\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 double\n"
           "0.1 0.1 0.1\n9 9 9\n0 0 0\n0.4 0 0\n0 0.4 0\n0 0 0.4\nCELLS 4 20\n"
           "4 0 3 4 5\n4 2 0 4 5\n4 2 3 0 5\n4 2 3 4 0\nCELL_TYPES 4\n10\n10\n10\n10\n";
    const auto with = [](const std::string& cell, const std::string& vertices) {
        return R"("frames": 5, "cloths": [], "soft_bodies": [{"name": "star", "file": ")" + cell +
               R"(, "young": 1e4}], "attachments": [{"cloth": "star", "select": {"vertices": [)" + vertices +
               "]}}]";
    };
    // Numbers 0 and 2 are the inner vertex and the corner on the x axis, which is 1 of the surface.
    World world = world_of(with(R"(star.vtk")", "2, 0"));
    const std::vector<Vec3> start = world.surfaces()[0].positions;
    run(world);
    for (size_t v = 0; v < start.size(); ++v) {
        const double fall = start[v].y() - world.surfaces()[0].positions[v].y();
        if (start[v].x() == 0.4)
            EXPECT_EQ(fall, 0.0) << v;
        else
            EXPECT_GT(std::abs(fall), 1e-6) << v;
    }
    EXPECT_NE(
        refusal(with(R"(star.vtk")", "5"))
            .find("attachments[0].select.vertices: vertex 5 is out of range; \"star\" has vertices 0 to 4"),
        std::string::npos);
    EXPECT_NE(refusal(with(R"(cube.obj", "cell": 0.1)", "0"))
                  .find("attachments[0].select.vertices: the tetrahedra that fill \"star\" have no numbers"),
              std::string::npos);
}

/// Until the ball rolls off.
TEST_F(SoftBodies, CarryClothAndSolidsAndEachOther)
{
    World world =
        world_of(kFloor + R"("frames": 21,
        "cloths": [{"name": "blanket", "rectangle": {"size": [0.3, 0.3], "resolution": 0.02}, "translate": [0.05, 0.215, 0.05]}],
        "solids": [{"name": "ball", "sphere": {"radius": 0.03}, "density": 500, "translate": [0.05, 0.26, 0.05]}],
        "soft_bodies": [)" +
                 block("lower", R"("young": 200000, "damping": 2, "translate": [0, 0.003, 0])") + ", " +
                 block("upper", R"("young": 200000, "damping": 2, "translate": [0.02, 0.108, 0.01])") + "]");
    run(world);
    const View<const ClothState> surfaces = world.surfaces();
    ASSERT_EQ(surfaces.size(), 4);
    EXPECT_EQ(surfaces[0].name, "blanket");
    EXPECT_EQ(surfaces[1].name, "ball");
    EXPECT_EQ(surfaces[2].name, "lower");
    EXPECT_EQ(surfaces[3].name, "upper");
    EXPECT_GT(mean(surfaces[3].positions).y(), 0.13); // on the lower one
    EXPECT_GT(mean(surfaces[1].positions).y(), 0.2);  // on the upper one and the blanket
    for (const int body : {2, 3})
        EXPECT_NEAR(volume_of(surfaces[body]), 1e-3, 2e-5);
}

TEST_F(SoftBodies, ShareTablesOfQuadratureWhereTheyAreEqual)
{
    const auto run = [&](const std::string& method) {
        WorldOptions options;
        options.tables = std::make_shared<TableStore>();
        World world = world_of(R"("fps": 60, "frames": 6, "solver": {"method": ")" + method + R"(",
            "outer": "lbfgs", "velocity_tolerance": 1e-4, "max_iterations": 400, "substeps": 4},
            "cloths": [], )" + kFloor +
                                   R"("soft_bodies": [)" +
                                   block("a", R"("young": 2e4, "translate": [0, 0.004, 0])") + ", " +
                                   block("b", R"("young": 2e4, "translate": [0.4, 0.01, 0.2],
                                         "rotate_deg": [20, 30, 0])") +
                                   "]",
                               options);
        for (int frame = 0; frame < 6; ++frame)
            EXPECT_EQ(world.advance_frame().unfinished, 0);
        return world;
    };
    const World exact = run("direct"), quadrature = run("quadrature");
    EXPECT_EQ(exact.stages().calls("quadrature/build"), 0);
    EXPECT_EQ(quadrature.stages().calls("quadrature/build"), 1);
    for (int s = 0; s < 2; ++s)
        for (size_t v = 0; v < exact.surfaces()[s].positions.size(); ++v)
            EXPECT_LT((exact.surfaces()[s].positions[v] - quadrature.surfaces()[s].positions[v]).norm(),
                      1e-4);
}

TEST_F(SoftBodies, FillSurfaces)
{
    std::ofstream(folder.path() / "cube.obj")
        << "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nv 0 0 10\nv 10 0 10\nv 10 10 10\nv 0 10 10\n"
           "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";
    World world = world_of(R"("frames": 20, "cloths": [], )" + kFloor + R"("soft_bodies": [
        {"name": "cube", "file": "cube.obj", "unit": "cm", "cell": 0.03, "translate": [0, 0.01, 0]}])");
    EXPECT_NEAR(volume_of(world.surfaces()[0]), 1e-3, 1e-9);
    EXPECT_GT(world.surfaces()[0].positions.size(), 50u);
    for (int frame = 0; frame < 20; ++frame)
        EXPECT_EQ(world.advance_frame().unfinished, 0);
    EXPECT_NEAR(volume_of(world.surfaces()[0]), 1e-3, 2e-5);
    EXPECT_GT(lowest(world.surfaces()[0].positions), 0.0);
}

TEST_F(SoftBodies, CarryRenderSurfacesThatNothingTouches)
{
    // The surface is a plate through the middle of the block, in its axes and unit; it crosses the block's.
    std::ofstream(folder.path() / "plate.obj")
        << "v 0 0.05 0\nv 0.105 0.05 0\nv 0.105 0.05 0.1\nv 0 0.05 0.1\nf 1 4 3 2\n";
    const std::string keys = R"("frames": 4, "cloths": [], "soft_bodies": [)" +
                             block("jelly", R"("young": 1e4, "render": "plate.obj", "translate": [0, 1, 0],
                                   "rotate_deg": [0, 0, 90], "scale": 2)") +
                             "]";
    World world = world_of(keys);
    ASSERT_EQ(world.surfaces().size(), 2);
    EXPECT_EQ(world.simulated().size(), 1);
    EXPECT_EQ(world.surfaces()[1].name, "jelly_render");
    EXPECT_LT((world.surfaces()[1].positions[1] - Vec3(-0.1, 1.21, 0.0)).norm(), 1e-12);
    run(world);
    const double fallen = 0.5 * 9.81 * 0.01;
    EXPECT_NEAR(world.surfaces()[1].positions[1].y(), 1.21 - fallen, 1e-3);
    EXPECT_EQ(world.snapshot()->positions(1).size(), 4);
    EXPECT_EQ(world.snapshot()->positions(1)[2], world.surfaces()[1].positions[2]);
    const auto of_file = [&](const std::string& more) {
        return refusal(R"("frames": 1, "cloths": [], "soft_bodies": [)" + block("jelly", more) + "]");
    };
    EXPECT_NE(of_file(R"("render": "plate.ply")").find("soft_bodies[0].render"), std::string::npos);
    EXPECT_NE(of_file(R"("render": "missing.obj")").find("missing.obj"), std::string::npos);
    EXPECT_NE(refusal(R"("frames": 1, "cloths": [], "solids": [{"name": "jelly_render", "sphere": {}}],
                      "soft_bodies": [)" +
                      block("jelly", R"("render": "plate.obj")") + "]")
                  .find("is written as \"jelly_render\""),
              std::string::npos);
}

TEST_F(SoftBodies, CountTetrahedraThatAreInsideOut)
{
    // All vertices are held. The one inside a block of 2 x 2 x 2 cells moves out through a face.
    const Block block = make_block(Vec3::Constant(0.1), {2, 2, 2});
    write_msh(folder.path() / "coarse.msh", block.mesh);
    World world = world_of(R"("frames": 3, "gravity": [0, 0, 0], "cloths": [], "soft_bodies": [
        {"name": "first", "file": "coarse.msh", "translate": [1, 0, 0]}, {"name": "jelly", "file": "coarse.msh"}],
        "attachments": [
        {"cloth": "jelly", "select": {"box": {"lower": [-1, -1, -1], "upper": [1, 0.01, 1]}}},
        {"cloth": "jelly", "select": {"box": {"lower": [-1, 0.09, -1], "upper": [1, 1, 1]}}},
        {"cloth": "jelly", "select": {"box": {"lower": [-1, 0.01, -1], "upper": [0.01, 0.09, 1]}}},
        {"cloth": "jelly", "select": {"box": {"lower": [0.09, 0.01, -1], "upper": [1, 0.09, 1]}}},
        {"cloth": "jelly", "select": {"box": {"lower": [0.01, 0.01, -1], "upper": [0.09, 0.09, 0.01]}}},
        {"cloth": "jelly", "select": {"box": {"lower": [0.01, 0.01, 0.09], "upper": [0.09, 0.09, 1]}}},
        {"cloth": "jelly", "select": {"box": {"lower": [0.01, 0.01, 0.01], "upper": [0.09, 0.09, 0.09]}},
         "keyframes": [{"time": 0, "translate": [0, 0, 0]}, {"time": 0.0667, "translate": [0.08, 0, 0]}]}])");
    EXPECT_EQ(world.inverted_tets(), std::vector<int>({0, 0}));
    world.advance_frame();
    EXPECT_EQ(world.inverted_tets(), std::vector<int>({0, 0}));
    world.advance_frame();

    std::vector<Vec3> x = block.mesh.positions;
    x[size_t(block.at(1, 1, 1))].x() += 0.08;
    int expected = 0;
    for (const volume::Tet& tet : block.mesh.tets) {
        Mat3 edges;
        for (int k = 0; k < 3; ++k)
            edges.col(k) = x[size_t(tet[size_t(k) + 1])] - x[size_t(tet[0])];
        expected += edges.determinant() <= 0.0 ? 1 : 0;
    }
    ASSERT_GT(expected, 0);
    EXPECT_EQ(world.inverted_tets(), std::vector<int>({0, expected}));
}

TEST_F(SoftBodies, HaveTheSameBitsForEveryThreadCount)
{
    std::vector<std::vector<Vec3>> found;
    for (const int threads : {1, 2, 5}) {
        World world = world_of(
            kFloor + R"("frames": 12, "solver": {"threads": )" + std::to_string(threads) +
            R"(}, "cloths": [{"name": "blanket", "translate": [0.05, 0.25, 0.05],
            "rectangle": {"size": [0.3, 0.3], "resolution": 0.03}}], "soft_bodies": [)" +
            block("lower", R"("young": 5000, "translate": [0, 0.02, 0], "rotate_deg": [20, 0, 30])") + ", " +
            block("upper", R"("young": 5000, "translate": [0.02, 0.14, 0.01])") + "]");
        run(world);
        std::vector<Vec3>& all = found.emplace_back();
        for (const ClothState& surface : world.surfaces())
            all.insert(all.end(), surface.positions.begin(), surface.positions.end());
    }
    EXPECT_EQ(found[0], found[1]);
    EXPECT_EQ(found[0], found[2]);
}

TEST_F(SoftBodies, DoNotBurdenScenesWithoutThem)
{
    World world = world_of(
        R"("frames": 3, "cloths": [{"name": "sheet", "rectangle": {"size": [0.1, 0.1], "resolution": 0.02}}])");
    run(world);
    EXPECT_EQ(world.stages().calls("elastic/project"), 0);
}

TEST_F(SoftBodies, HaveNoAttributesInCaches)
{
    const auto exported = [&](const std::string& cloth) {
        return refusal(R"("frames": 1, "cloths": [{"name": "sheet", "disc": {}}], "soft_bodies": [)" +
                       block("jelly", R"("young": 1e3)") +
                       R"(], "export": [{"file": "a.abc", "attributes": ["strain"], "cloth": )" + cloth +
                       "}]");
    };
    EXPECT_NE(exported(R"("jelly")")
                  .find("export[0].attributes: are of cloths, and the entry writes none; "
                        "leave them out, or add a cloth to \"cloth\""),
              std::string::npos);
    for (const char* cloth : {R"("all")", R"("sheet")", R"(["jelly", "sheet"])"})
        EXPECT_EQ(exported(cloth).find("attributes"), std::string::npos) << cloth;
}

TEST_F(SoftBodies, AreRefusedWithTheReason)
{
    const auto with = [&](const std::string& keys) {
        return R"("frames": 1, "cloths": [], "soft_bodies": [)" + block("jelly", keys) + "]";
    };
    EXPECT_NE(refusal(with(R"("poisson": 0.5)")).find("soft_bodies[0].poisson"), std::string::npos);
    EXPECT_NE(refusal(with(R"("young": 0)")).find("soft_bodies[0].young"), std::string::npos);
    EXPECT_NE(refusal(with(R"("density": -1)")).find("soft_bodies[0].density"), std::string::npos);
    EXPECT_NE(refusal(with(R"("young": 1e3)") + R"(, "contact": {"self": false})").find("contact.self"),
              std::string::npos);
    EXPECT_NE(refusal(R"("frames": 1, "cloths": [], "soft_bodies": [{"name": "a", "file": "missing.msh"}])")
                  .find("missing.msh"),
              std::string::npos);
    EXPECT_NE(refusal(with(R"("cell": 0.02)")).find("soft_bodies[0].cell"), std::string::npos);
    EXPECT_NE(refusal(R"("frames": 1, "cloths": [], "soft_bodies": [{"name": "a", "file": "a.obj"}])")
                  .find("\"cell\": 0.02"),
              std::string::npos);
    EXPECT_NE(
        refusal(R"("frames": 1, "cloths": [], "soft_bodies": [{"name": "a", "file": "a.stl"}])").find(".msh"),
        std::string::npos);
    EXPECT_NE(
        refusal(
            R"("frames": 1, "cloths": [], "solids": [{"name": "jelly", "sphere": {"radius": 1}}], "soft_bodies": [)" +
            block("jelly", R"("young": 1e3)") + "]")
            .find("is the name of a cloth, avatar or solid"),
        std::string::npos);
    EXPECT_NE(
        refusal(
            with(R"("young": 1e3)") +
            R"(, "attachments": [{"cloth": "jelly", "select": {"box": {"lower": [5, 5, 5], "upper": [6, 6, 6]}}}])")
            .find("selects no vertex of \"jelly\""),
        std::string::npos);
}

} // namespace
} // namespace toile::test
