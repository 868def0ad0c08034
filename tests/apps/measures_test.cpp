#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <thread>

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include "apps/toile/cloth/strain.h"
#include "apps/toile/render/frame_range.h"
#include "apps/toile/terminal/progress.h"
#include "apps/toile/terminal/setup_progress.h"
#include "core/base/error.h"
#include "scenes/meshes/shape_mesh.h"

namespace toile::test {

using namespace app;
using namespace collision;
using namespace scenes;

namespace {

const std::vector<unsigned char> kFree(4, 0);

TEST(StrainMeter, TellsTrianglesBetweenAttachedVerticesApart)
{
    const std::vector<Vec3> rest{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    std::vector<Vec3> x = rest;
    x[0].x() = -0.5; // of the first triangle only
    x[3].y() = 1.25; // of the second only
    const StrainMeter meter(rest, {Triangle(0, 1, 2), Triangle(1, 3, 2)});
    const std::vector<unsigned char> first{1, 1, 1, 0}, second{0, 1, 1, 1};
    const double of_first = meter.largest(x, second).of_free, of_second = meter.largest(x, first).of_free;
    EXPECT_GT(of_first, 0.4);
    EXPECT_LT(of_second, 0.4);
    EXPECT_EQ(meter.largest(x, first).of_attached, of_first);
    EXPECT_EQ(meter.largest(x, second).of_attached, of_second);
    EXPECT_EQ(meter.largest(x, kFree).of_attached, -1.0);
    EXPECT_EQ(meter.largest(x, kFree).of_free, of_first);
}

TEST(StrainMeter, IsZeroAtRestAndAfterARigidMotion)
{
    const std::vector<Vec3> rest{{0, 0, 0}, {0.1, 0, 0}, {0.03, 0.02, 0.08}, {0.1, 0.1, 0.1}};
    const StrainMeter meter(rest, {Triangle(0, 1, 2), Triangle(1, 3, 2)});
    EXPECT_NEAR(meter.largest(rest, kFree).of_free, 0.0, 1e-14);
    const Mat3 Q = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    std::vector<Vec3> moved = rest;
    for (Vec3& p : moved)
        p = Q * p + Vec3(1, 2, 3);
    EXPECT_NEAR(meter.largest(moved, kFree).of_free, 0.0, 1e-13);
}

/// Panels lie anywhere in the plane, mirrored or not.
TEST(StrainMeter, MeasuresAgainstPanels)
{
    const std::vector<FlatTriangle> panels{{Vec2(5, 5), Vec2(6, 5), Vec2(5, 6)},
                                           {Vec2(0, 0), Vec2(-1, 1), Vec2(0, 1)}};
    const StrainMeter meter(panels, {Triangle(0, 1, 2), Triangle(1, 3, 2)});
    EXPECT_NEAR(meter.rest_area(), 1.0, 1e-15);
    std::vector<Vec3> x{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    EXPECT_NEAR(meter.largest(x, kFree).of_free, std::sqrt(1.5 + std::sqrt(1.25)) - 1.0, 1e-14)
        << "the second triangle is sheared by one";
    for (Vec3& p : x)
        p.y() *= 1.1;
    const StrainMeter first({panels[0]}, {Triangle(0, 1, 2)});
    EXPECT_NEAR(first.largest(x, kFree).of_free, 0.1, 1e-14);
}

TEST(StrainMeter, AgreesWithTheSingularValuesOfRandomDeformations)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    for (int k = 0; k < 100; ++k) {
        std::vector<Vec3> rest(3), x(3);
        for (int i = 0; i < 3; ++i) {
            rest[size_t(i)] = Vec3(number(random), number(random), 0.0);
            x[size_t(i)] = Vec3(number(random), number(random), number(random));
        }
        Mat2 rest_edges;
        rest_edges << (rest[1] - rest[0]).head<2>(), (rest[2] - rest[0]).head<2>();
        Mat32 edges;
        edges.col(0) = x[1] - x[0];
        edges.col(1) = x[2] - x[0];
        const Mat2 inverse = rest_edges.inverse();
        Eigen::MatrixXd F(3, 2);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 2; ++j)
                F(i, j) = edges(i, 0) * inverse(0, j) + edges(i, 1) * inverse(1, j);
        const Eigen::Vector2d sigma = Eigen::JacobiSVD<Eigen::MatrixXd>(F).singularValues();
        const StrainMeter meter(rest, {Triangle(0, 1, 2)});
        EXPECT_NEAR(meter.largest(x, kFree).of_free, sigma[0] - 1.0, 1e-10 * sigma[0]);
        EXPECT_NEAR(meter.stretches(x, 0).larger, sigma[0], 1e-10 * sigma[0]);
        EXPECT_NEAR(meter.stretches(x, 0).smaller, sigma[1], 1e-10 * sigma[0]);
        EXPECT_NEAR(meter.rest_area(0), 0.5 * std::abs(rest_edges.determinant()), 1e-12);
    }
}

/// Volume by the divergence theorem; positive only if the triangles face outwards.
double volume(const TriangleMesh& mesh)
{
    double sum = 0.0;
    for (const Triangle& t : mesh.triangles)
        sum += mesh.positions[t[0]].dot(mesh.positions[t[1]].cross(mesh.positions[t[2]])) / 6.0;
    return sum;
}

TEST(ShapeMesh, EnclosesTheVolumeOfItsSolid)
{
    EXPECT_NEAR(volume(shape_mesh(BoxShape{Vec3(0.1, 0.2, 0.3)}, 0.0)), 0.048, 1e-12);
    const double ball = 4.0 / 3.0 * M_PI * 0.5 * 0.5 * 0.5;
    EXPECT_NEAR(volume(shape_mesh(SphereShape{0.5}, 0.0)), ball, 0.01 * ball);
    const double tube = M_PI * 0.5 * 0.5 * 2.0;
    EXPECT_NEAR(volume(shape_mesh(CapsuleShape{1.0, 0.5}, 0.0)), ball + tube, 0.01 * (ball + tube));
}

TEST(ShapeMesh, ShowsAPlaneFromAbove)
{
    const TriangleMesh plane = shape_mesh(PlaneShape{}, 2.0);
    const Triangle& t = plane.triangles.at(0);
    const Vec3 a = plane.positions[t[1]] - plane.positions[t[0]],
               b = plane.positions[t[2]] - plane.positions[t[0]];
    EXPECT_GT(a.cross(b).y(), 0.0);
    EXPECT_DOUBLE_EQ(bounds(plane.positions).upper.x(), 1.0);
}

TEST(FrameRange, ReadsFirstLastAndStep)
{
    EXPECT_EQ(parse_frame_range("", 3), (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(parse_frame_range("1", 3), (std::vector<int>{1}));
    EXPECT_EQ(parse_frame_range("-1", 3), (std::vector<int>{2}));
    EXPECT_EQ(parse_frame_range("1:", 4), (std::vector<int>{1, 2, 3}));
    EXPECT_EQ(parse_frame_range(":2", 4), (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(parse_frame_range("0:-2:2", 8), (std::vector<int>{0, 2, 4, 6}));
    for (const char* bad : {"3", "-4", "2:1", "0:3", "0:2:0", "a", "1:2:3:4", "1.5"})
        EXPECT_THROW(parse_frame_range(bad, 3), InvalidInput) << bad;
}

TEST(ClockText, ShowsHoursOnlyFromOneHourOn)
{
    EXPECT_EQ(clock_text(0.4), "0:00");
    EXPECT_EQ(clock_text(75.0), "1:15");
    EXPECT_EQ(clock_text(3675.0), "1:01:15");
}

/// Output of SetupProgress until the tables are finished, with a pause after the first call.
std::string told_of_tables(bool quiet, std::chrono::milliseconds pause)
{
    testing::internal::CaptureStderr();
    {
        SetupProgress progress(quiet);
        progress.update("tables of cloth \"skirt\"", 0.1);
        std::this_thread::sleep_for(pause);
        progress.update("tables of cloth \"skirt\"", 0.4);
        progress.update("tables of cloth \"skirt\"", 0.5);
        progress.update("tables of cloth \"skirt\"", 1.0);
    }
    return testing::internal::GetCapturedStderr();
}

TEST(SetupProgress, ReportsBuildsLongerThanHalfASecond)
{
    EXPECT_EQ(told_of_tables(false, std::chrono::milliseconds(0)), "");
    EXPECT_EQ(told_of_tables(true, std::chrono::milliseconds(600)), "");
    const std::string told = told_of_tables(false, std::chrono::milliseconds(600));
    EXPECT_EQ(told.rfind("tables of cloth \"skirt\": 40 %, ", 0), 0u) << told;
    EXPECT_NE(told.find(" left\ntables of cloth \"skirt\": 100 %, done in "), std::string::npos) << told;
}

TEST(SetupProgress, FormatsDurations)
{
    EXPECT_EQ(duration_text(3.2), "3 s");
    EXPECT_EQ(duration_text(75.0), "1:15");
}

} // namespace
} // namespace toile::test
