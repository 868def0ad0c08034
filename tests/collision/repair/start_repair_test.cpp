#include "collision/repair/repair_start.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "collision/check/find_crossings.h"
#include "core/compute/parallel.h"
#include "tests/collision/shapes_for_tests.h"

namespace toile::test {

using namespace collision;

namespace {

using testing::sheet_mesh;
using testing::sphere_mesh;
using Kind = StartDefect::Kind;

StartCloth cloth_of(const TriangleMesh& mesh, int layer = 0)
{
    StartCloth cloth;
    cloth.triangles = mesh.triangles;
    cloth.positions = mesh.positions;
    cloth.layer = layer;
    return cloth;
}

MeshCollider body_of(const TriangleMesh& mesh)
{
    return MeshCollider({mesh.triangles, mesh.positions, mesh.positions});
}

/// Mesh of columns x rows quads in space: at(u, v) for u and v in [0, 1].
template <typename At>
TriangleMesh patch(int columns, int rows, const At& at)
{
    TriangleMesh mesh = sheet_mesh(1.0, 1, 0.0);
    mesh.positions.clear();
    mesh.triangles.clear();
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i)
            mesh.positions.push_back(at(double(i) / columns, double(j) / rows));
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const int a = j * (columns + 1) + i, c = a + columns + 1;
            mesh.triangles.push_back(Triangle(a, c, a + 1));
            mesh.triangles.push_back(Triangle(a + 1, c, c + 1));
        }
    return mesh;
}

/// Open tube about the y axis, facing outwards, its seam welded.
TriangleMesh tube_mesh(double radius, double length, int segments, int along)
{
    TriangleMesh mesh;
    for (int j = 0; j <= along; ++j)
        for (int i = 0; i < segments; ++i) {
            const double angle = 2.0 * std::numbers::pi * i / segments;
            mesh.positions.push_back(
                Vec3(radius * std::sin(angle), length * (double(j) / along - 0.5), radius * std::cos(angle)));
        }
    for (int j = 0; j < along; ++j)
        for (int i = 0; i < segments; ++i) {
            const int a = j * segments + i, b = j * segments + (i + 1) % segments;
            mesh.triangles.push_back(Triangle(a, b, a + segments));
            mesh.triangles.push_back(Triangle(b, b + segments, a + segments));
        }
    return mesh;
}

TEST(CheckStart, FindsNothingInACleanPose)
{
    const MeshCollider ball = body_of(sphere_mesh(Vec3::Zero(), 0.1, 3));
    const std::vector<StartCloth> cloths{cloth_of(sheet_mesh(0.3, 20, 0.101)),
                                         cloth_of(sheet_mesh(0.3, 20, 0.103))};
    EXPECT_TRUE(check_start(cloths, {{&ball, nullptr}}).defects.empty());
}

TEST(CheckStart, ReportsVerticesInsideAndTheirDepth)
{
    const ShapeCollider ball(SphereShape{0.1}, Eigen::Isometry3d::Identity(), "ball");
    const StartReport report = check_start({cloth_of(sheet_mesh(0.3, 20, 0.08))}, {{nullptr, &ball}});
    ASSERT_FALSE(report.defects.empty());
    EXPECT_NEAR(report.deepest(Kind::InsideBody), 0.02, 1e-12);
    for (const StartDefect& defect : report.defects)
        if (defect.kind == Kind::InsideBody) {
            EXPECT_NEAR(defect.depth, 0.1 - defect.position.norm(), 1e-12);
        }
    // Grid points within the circle that the sheet's plane cuts out of the ball: radius 6 cm, pitch 1.5 cm.
    EXPECT_EQ(report.vertices_inside(), 45);
    EXPECT_FALSE(report.was_repaired);
}

TEST(RepairStart, PushesASheetOutOfABall)
{
    const MeshCollider mesh = body_of(sphere_mesh(Vec3::Zero(), 0.1, 4));
    const ShapeCollider solid(SphereShape{0.1}, Eigen::Isometry3d::Identity(), "ball");
    for (const ContactCollider& body : {ContactCollider{&mesh, nullptr}, {nullptr, &solid}}) {
        std::vector<StartCloth> cloths{cloth_of(sheet_mesh(0.4, 24, 0.07))};
        const StartReport report = repair_start(cloths, {body});
        EXPECT_GT(report.count(Kind::InsideBody), 0);
        EXPECT_EQ(report.remaining(Kind::InsideBody), 0);
        EXPECT_EQ(report.remaining(Kind::Crossing), 0);
        EXPECT_TRUE(check_start(cloths, {body}).defects.empty());
        EXPECT_GT(report.max_move, 0.03) << "the top of the ball is 3 cm above the sheet";
        EXPECT_LT(report.rms_strain, 0.03);
        EXPECT_LT(report.max_strain, 0.15);
    }
}

TEST(RepairStart, WidensATubeThatABallSticksThrough)
{
    const MeshCollider ball = body_of(sphere_mesh(Vec3(0.002, 0, 0), 0.105, 4));
    std::vector<StartCloth> cloths{cloth_of(tube_mesh(0.1, 0.3, 48, 24))};
    const StartReport report = repair_start(cloths, {{&ball, nullptr}});
    EXPECT_GT(report.vertices_inside(), 200);
    EXPECT_EQ(report.remaining(Kind::InsideBody), 0);
    EXPECT_EQ(report.remaining(Kind::Crossing), 0);
    EXPECT_LT(report.max_strain, 0.12) << "the ball's own girth asks for 7 %";
}

/// Two sheets that cross along a line, `a` rising and `b` falling along x.
std::vector<StartCloth> crossing_sheets(int layer_a, int layer_b)
{
    const auto tilted = [](double slope, double shift) {
        return patch(20, 20, [=](double u, double v) {
            return Vec3(0.3 * (u - 0.5) + shift, slope * 0.3 * (u - 0.5), 0.3 * (0.5 - v) + shift);
        });
    };
    TriangleMesh a = tilted(0.12, 0.0), b = tilted(-0.12, 0.0037);
    for (TriangleMesh* mesh : {&a, &b})
        for (Triangle& t : mesh->triangles)
            std::swap(t[1], t[2]); // z decreases along v: the other winding faces up
    return {cloth_of(a, layer_a), cloth_of(b, layer_b)};
}

TEST(RepairStart, BringsTheHigherLayerOutside)
{
    for (const bool a_is_outside : {true, false}) {
        std::vector<StartCloth> cloths = crossing_sheets(a_is_outside ? 1 : 0, a_is_outside ? 0 : 1);
        const StartReport report = repair_start(cloths, {});
        EXPECT_GT(report.count(Kind::Crossing), 10);
        EXPECT_EQ(report.remaining(Kind::Crossing), 0);
        EXPECT_LT(report.rms_strain, 0.03);

        // Every vertex of the outer sheet is above the inner one, if that is below it at all.
        const StartCloth &inner = cloths[a_is_outside ? 1 : 0], &outer = cloths[a_is_outside ? 0 : 1];
        const SurfaceProximity surface(inner.triangles, inner.positions);
        int above = 0, below = 0;
        for (const Vec3& p : outer.positions)
            if (std::abs(p.x()) < 0.12 && std::abs(p.z()) < 0.12)
                ++(surface.closest(p)->signed_distance > 0.0 ? above : below);
        EXPECT_EQ(below, 0) << "a outside: " << a_is_outside;
        EXPECT_GT(above, 100);
    }
}

TEST(RepairStart, TakesTheOutsideOfClosedClothForThatOfALayer)
{
    // A ball, of which the upper part is too far from the floor for its normal to count.
    for (const double height : {0.07, 0.08, 0.09}) {
        std::vector<StartCloth> cloths{cloth_of(sphere_mesh(Vec3(0, height, 0), 0.04, 3), 0),
                                       cloth_of(sheet_mesh(0.1, 20, height + 0.037), 1)};
        const ShapeCollider floor(PlaneShape{}, Eigen::Isometry3d::Identity(), "floor");
        const StartReport report = repair_start(cloths, {{nullptr, &floor}});
        EXPECT_GT(report.count(Kind::Crossing), 4);
        EXPECT_EQ(report.remaining(Kind::Crossing), 0) << height;
        const SurfaceProximity ball(cloths[0].triangles, cloths[0].positions);
        for (const Vec3& p : cloths[1].positions)
            EXPECT_GT(ball.closest(p)->signed_distance, 0.0) << height;
    }
}

TEST(RepairStart, ResolvesEqualLayers)
{
    std::vector<StartCloth> cloths = crossing_sheets(0, 0);
    const StartReport report = repair_start(cloths, {});
    EXPECT_GT(report.count(Kind::Crossing), 10);
    EXPECT_EQ(report.remaining(Kind::Crossing), 0);
    EXPECT_LT(report.rms_strain, 0.03);
}

TEST(RepairStart, TakesCoincidentClothsApartByLayer)
{
    for (const bool first_is_outside : {true, false}) {
        const TriangleMesh sheet = sheet_mesh(0.3, 12, 0.0);
        std::vector<StartCloth> cloths{cloth_of(sheet, first_is_outside ? 1 : 0),
                                       cloth_of(sheet, first_is_outside ? 0 : 1), cloth_of(sheet, 2)};
        const ShapeCollider floor(PlaneShape{}, Eigen::Isometry3d(Eigen::Translation3d(0, -0.01, 0)),
                                  "floor");
        const StartReport report = repair_start(cloths, {{nullptr, &floor}});
        EXPECT_GT(report.count(Kind::Crossing), 100);
        EXPECT_EQ(report.remaining(Kind::Crossing), 0);
        EXPECT_LT(report.max_move, 0.002);
        const StartCloth &inner = cloths[first_is_outside ? 1 : 0], &outer = cloths[first_is_outside ? 0 : 1];
        for (size_t v = 0; v < sheet.positions.size(); ++v) {
            EXPECT_GT(outer.positions[v].y(), inner.positions[v].y());
            EXPECT_GT(cloths[2].positions[v].y(), outer.positions[v].y());
        }
    }
}

TEST(RepairStart, TakesCoincidentClothsOfOneLayerApart)
{
    const TriangleMesh sheet = sheet_mesh(0.3, 12, 0.0);
    std::vector<StartCloth> cloths{cloth_of(sheet), cloth_of(sheet)};
    EXPECT_EQ(repair_start(cloths, {}).remaining(Kind::Crossing), 0);
    EXPECT_TRUE(check_start(cloths, {}).is_clean());
}

TEST(RepairStart, BringsACoatOutsideAShirtThatItLiesUnder)
{
    const MeshCollider ball = body_of(sphere_mesh(Vec3::Zero(), 0.1, 3));
    std::vector<StartCloth> cloths{cloth_of(sphere_mesh(Vec3::Zero(), 0.11, 3), 0),
                                   cloth_of(sphere_mesh(Vec3::Zero(), 0.105, 3), 1)};
    const StartReport report = repair_start(cloths, {{&ball, nullptr}});
    EXPECT_EQ(report.count(Kind::UnderLayer), 1);
    EXPECT_EQ(report.remaining(Kind::UnderLayer), 0);
    EXPECT_EQ(report.remaining(Kind::Crossing), 0);
    for (const Vec3& p : cloths[1].positions)
        EXPECT_GT(p.norm(), 0.11);
    for (const Vec3& p : cloths[0].positions)
        EXPECT_NEAR(p.norm(), 0.11, 1e-3);
}

TEST(RepairStart, LiftsClothCutFromTheFacesOfABody)
{
    const TriangleMesh sphere = sphere_mesh(Vec3::Zero(), 0.1, 3);
    const MeshCollider ball = body_of(sphere);
    TriangleMesh cap{sphere.positions, {}};
    for (const Triangle& t : sphere.triangles)
        if (sphere.positions[t[0]].y() > 0.0)
            cap.triangles.push_back(t);
    std::vector<StartCloth> cloths{cloth_of(cap)};
    const StartReport report = repair_start(cloths, {{&ball, nullptr}});
    EXPECT_GT(report.count(Kind::CrossesBody), 100);
    EXPECT_EQ(report.remaining(Kind::CrossesBody), 0);
    EXPECT_LT(report.max_move, 0.003);
    EXPECT_TRUE(
        find_crossings(cap.triangles, cloths[0].positions, sphere.triangles, sphere.positions).empty());
}

TEST(RepairStart, ReportsItsProgress)
{
    const ShapeCollider ball(SphereShape{0.1}, Eigen::Isometry3d::Identity(), "ball");
    std::vector<StartCloth> cloths{cloth_of(sheet_mesh(0.4, 24, 0.07))};
    std::vector<double> told;
    repair_start(cloths, {{nullptr, &ball}},
                 RepairProgress([&](double fraction) { told.push_back(fraction); }));
    EXPECT_GT(told.size(), 10u);
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_EQ(told.back(), 1.0);
}

TEST(RepairStart, UntanglesASheetThatCrossesItself)
{
    // A rolled-up sheet whose ends overlap by 40 degrees; a dent in the outer end crosses the inner one.
    std::vector<StartCloth> cloths{cloth_of(patch(60, 20, [](double u, double v) {
        const double dent = std::exp(-(std::pow((u - 0.94) / 0.03, 2) + std::pow((v - 0.47) / 0.2, 2)));
        const double angle = (u - 0.5) * 400.0 * std::numbers::pi / 180.0;
        const double radius = 0.1 + 0.003 * (2.0 * u - 1.0) - 0.012 * dent;
        return Vec3(radius * std::sin(angle), 0.2 * v, radius * std::cos(angle));
    }))};
    const StartReport report = repair_start(cloths, {});
    EXPECT_GT(report.count(Kind::Crossing), 3);
    EXPECT_EQ(report.remaining(Kind::Crossing), 0);
    EXPECT_TRUE(find_crossings(cloths[0].triangles, cloths[0].positions).empty());
    EXPECT_LT(report.max_strain, 0.1);
}

TEST(RepairStart, KeepsFixedVerticesAndReportsThem)
{
    const ShapeCollider floor(PlaneShape{}, Eigen::Isometry3d::Identity(), "floor");
    std::vector<StartCloth> cloths{cloth_of(sheet_mesh(0.2, 10, -0.004))};
    cloths[0].fixed.assign(cloths[0].positions.size(), 0);
    cloths[0].fixed[0] = 1;
    const Vec3 held = cloths[0].positions[0];
    const StartReport report = repair_start(cloths, {{nullptr, &floor}});
    EXPECT_EQ(cloths[0].positions[0], held);
    EXPECT_EQ(report.vertices_inside(), 121);
    int fixed_defects = 0;
    for (const StartDefect& defect : report.defects)
        if (defect.kind == Kind::InsideBody && defect.vertex[1] < 0) {
            EXPECT_EQ(defect.is_repaired, defect.vertex[0] != 0);
            fixed_defects += defect.is_fixed ? 1 : 0;
        }
    EXPECT_EQ(fixed_defects, 1);
}

TEST(RepairStart, GivesTheSameBitsForEveryNumberOfThreads)
{
    const auto repaired = [](int threads) {
        const ThreadLimit limit(threads);
        const MeshCollider ball = body_of(sphere_mesh(Vec3::Zero(), 0.1, 3));
        std::vector<StartCloth> cloths = crossing_sheets(0, 1);
        for (StartCloth& cloth : cloths)
            for (Vec3& p : cloth.positions)
                p.y() += 0.095;
        repair_start(cloths, {{&ball, nullptr}});
        return std::pair(cloths[0].positions, cloths[1].positions);
    };
    EXPECT_EQ(repaired(1), repaired(4));
}

} // namespace
} // namespace toile::test
