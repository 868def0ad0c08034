#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/mesh/topology.h"
#include "garment/energy/fold/dihedral_angle.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"
#include "tests/scenes/folds/folded_strip.h"
#include "tests/support/temporary_folder.h"

/// Cloth that is folded at rest.
namespace toile::test {

using namespace scenes;

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

class FoldedStrip : public testing::Test {
protected:
    /// Strip whose left half is fixed, folded in the middle.
    /// @param keys  more keys of the scene
    World world_of(const std::string& folds, const std::string& keys)
    {
        folder_.write("strip.obj", strip_.obj());
        return World(parse_scene(
            R"({"toile": 1, "frames": 400, "cloths": [{"name": "c", "file": "strip.obj",
            "fabric": "stiff")" +
                (folds.empty() ? "" : R"(, "folds": [)" + folds + "]") +
                R"(}], "fabrics": {"stiff": {"bend": {"warp": 1e-3, "weft": 1e-3}, "bend_friction": 0}},
            "solver": {"velocity_tolerance": 1e-4, "sleep": {"enabled": false}},
            "attachments": [{"cloth": "c", "select": {"vertices": )" +
                strip_.first_columns(strip_.columns / 2 + 1) + "}}], " + keys + "}",
            folder_.path() / "scene.json"));
    }

    std::string fold(double angle_deg, double stiffness) const
    {
        return R"({"vertices": )" + strip_.column(strip_.columns / 2) + R"(, "angle_deg": )" +
               std::to_string(angle_deg) + R"(, "stiffness": )" + std::to_string(stiffness) + "}";
    }

    static void advance(World& world, double seconds)
    {
        for (int frame = 0; frame < 30.0 * seconds; ++frame)
            EXPECT_NE(world.advance_frame().status, StepReport::Status::NonFinite);
    }

    TemporaryFolder folder_;
    Strip strip_;
};

TEST_F(FoldedStrip, ComesToItsRestAngle)
{
    for (const double angle : {-170.0, -90.0, 30.0, 120.0, 175.0}) {
        World world = world_of(fold(angle, 0.05), R"("gravity": [0, 0, 0], "contact": {"self": false})");
        advance(world, 3.0);
        for (int k = 0; k <= strip_.rows; ++k)
            EXPECT_NEAR(strip_.angle(world.cloths()[0].positions, k) / kDegree, angle, 0.5);
        // Beside the fold the halves are flat.
        const View<const Vec3> x = world.cloths()[0].positions;
        const double reach =
            (x[strip_.vertex(strip_.columns, 0)] - x[strip_.vertex(strip_.columns / 2, 0)]).norm();
        EXPECT_NEAR(reach, 0.01 * strip_.columns / 2, 1e-4);
    }
}

/// At half a turn contact holds the cells beside the fold apart, by about the thickness of the cloth.
TEST_F(FoldedStrip, FoldsFlatOntoItself)
{
    World world = world_of(fold(180.0, 0.05), R"("gravity": [0, 0, 0])");
    advance(world, 3.0);
    const View<const Vec3> x = world.cloths()[0].positions;
    const double thickness = world.cloths()[0].fabric.thickness;
    for (int i = 1; i <= strip_.columns / 2; ++i) {
        const double gap = x[strip_.vertex(strip_.columns / 2 + i, 1)].y();
        EXPECT_GT(gap, 0.0) << i;
        EXPECT_LT(gap, 2.0 * thickness * i) << i; // the cells beside the fold leave a wedge
    }
}

/// The moment of the weight of the free half about the fold is k l (theta - theta0).
TEST_F(FoldedStrip, OpensUnderAMomentByThatOverItsStiffness)
{
    for (const double stiffness : {0.02, 0.05}) {
        World world = world_of(fold(60.0, stiffness), R"("contact": {"self": false})");
        advance(world, 10.0);
        const View<const Vec3> x = world.cloths()[0].positions;
        const double cell_mass = world.cloths()[0].fabric.areal_density * 1e-4;
        double moment = 0.0; // [N m]
        for (int i = strip_.columns / 2 + 1; i <= strip_.columns; ++i)
            for (int k = 0; k <= strip_.rows; ++k) {
                // Each triangle gives its corners a third; the diagonal is that of (i, k) to (i + 1, k + 1).
                int triangles = 0;
                for (const auto& [di, dk, count] : {std::tuple{0, 0, 2}, {-1, -1, 2}, {-1, 0, 1}, {0, -1, 1}})
                    if (i + di >= 0 && i + di < strip_.columns && k + dk >= 0 && k + dk < strip_.rows)
                        triangles += count;
                const double mass = triangles * cell_mass / 6.0;
                moment += 9.81 * mass * (x[strip_.vertex(i, k)].x() - 0.01 * strip_.columns / 2);
            }
        double opening = 0.0; // [rad m] sum of l (theta - theta0)
        for (const Edge& edge :
             build_topology(world.cloths()[0].triangles, strip_.vertex_count(), "strip").edges)
            if (edge.vertex[0] / (strip_.rows + 1) == strip_.columns / 2 &&
                edge.vertex[1] / (strip_.rows + 1) == strip_.columns / 2)
                opening += 0.01 * (garment::dihedral_angle({x[edge.vertex[0]], x[edge.vertex[1]],
                                                            x[edge.opposite[0]], x[edge.opposite[1]]}) -
                                   60.0 * kDegree);
        EXPECT_GT(moment, 0.08 * stiffness * 0.04) << "the weight opens it by more than 4 degrees";
        EXPECT_NEAR(-stiffness * opening, moment, 0.01 * moment);
    }
}

} // namespace
} // namespace toile::test
