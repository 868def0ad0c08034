#include "collision/geometry/surface_proximity.h"

#include <algorithm>
#include <filesystem>
#include <random>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "collision/bvh/ray_scene.h"
#include "core/compute/parallel.h"
#include "core/mesh/obj.h"
#include "tests/collision/shapes_for_tests.h"

namespace toile::test {

using namespace collision;

namespace {

using testing::box_mesh;
using testing::sheet_mesh;
using testing::sphere_mesh;

std::vector<Vec3> random_points(unsigned seed, int count, const Vec3& center, double reach)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-reach, reach);
    std::vector<Vec3> points(count);
    for (Vec3& point : points)
        point = center + Vec3(uniform(random), uniform(random), uniform(random));
    return points;
}

ClosestOnTriangle closest_on(const TriangleMesh& mesh, int t, const Vec3& p)
{
    const Triangle& corner = mesh.triangles[t];
    return closest_on_triangle(p, mesh.positions[corner[0]], mesh.positions[corner[1]],
                               mesh.positions[corner[2]]);
}

/// Lowest triangle of min distance up to rounding, by brute force.
int closest_by_brute_force(const TriangleMesh& mesh, const Vec3& p)
{
    constexpr double kRounding = 1e-14; // [m]
    std::vector<double> distance;
    distance.reserve(mesh.triangles.size());
    for (int t = 0; t < mesh.triangle_count(); ++t)
        distance.push_back(std::sqrt(closest_on(mesh, t, p).distance2));
    const double min_distance = *std::min_element(distance.begin(), distance.end());
    return int(std::find_if(distance.begin(), distance.end(),
                            [&](double other) { return other <= min_distance + kRounding; }) -
               distance.begin());
}

TriangleMesh noisy_sphere()
{
    TriangleMesh mesh = sphere_mesh(Vec3(0.5, 1.5, -0.7), 0.3, 4);
    const std::vector<Vec3> noise = random_points(8, mesh.vertex_count(), Vec3::Zero(), 0.004);
    for (int v = 0; v < mesh.vertex_count(); ++v)
        mesh.positions[v] += noise[v];
    return mesh;
}

TEST(SurfaceProximity, FindsTheLowestOfTheClosestTriangles)
{
    const TriangleMesh mesh = noisy_sphere();
    const SurfaceProximity surface(mesh.triangles, mesh.positions);
    for (const Vec3& p : random_points(9, 500, Vec3(0.5, 1.5, -0.7), 0.4)) {
        const int expected = closest_by_brute_force(mesh, p);
        const std::optional<SurfacePoint> found = surface.closest(p);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->triangle, expected);
        EXPECT_NEAR(found->distance(), std::sqrt(closest_on(mesh, expected, p).distance2), 1e-15);
        EXPECT_EQ(surface.closest(p, 1.0, 77)->triangle, expected) << "a hint must not change the answer";
        EXPECT_FALSE(surface.closest(p, found->distance() * (1 - 1e-9)));
        EXPECT_TRUE(surface.closest(p, found->distance() * (1 + 1e-9)));
    }
}

TEST(SurfaceProximity, BreaksTiesByTriangleNumber)
{
    const TriangleMesh mesh = box_mesh(Vec3::Zero(), Vec3::Ones());
    const SurfaceProximity surface(mesh.triangles, mesh.positions);
    for (const Vec3& p :
         {Vec3(0.5, 0.5, 0.5), Vec3(-1, -1, -1), Vec3(2, 2, 2), Vec3(0.5, 2, 0.5), Vec3(2, 2, 0.3)})
        EXPECT_EQ(surface.closest(p)->triangle, closest_by_brute_force(mesh, p)) << p.transpose();
}

TEST(SurfaceProximity, ListsTheTrianglesWithinARadiusAscending)
{
    const TriangleMesh mesh = noisy_sphere();
    const SurfaceProximity surface(mesh.triangles, mesh.positions);
    std::vector<int> found, superset;
    for (const Vec3& p : random_points(10, 200, Vec3(0.5, 1.5, -0.7), 0.4))
        for (const double radius : {0.01, 0.1}) {
            std::vector<int> expected;
            for (int t = 0; t < mesh.triangle_count(); ++t)
                if (closest_on(mesh, t, p).distance2 <= radius * radius)
                    expected.push_back(t);
            surface.triangles_within(p, radius, found);
            EXPECT_EQ(found, expected);
            surface.triangles_maybe_near(p, p, radius, superset);
            std::sort(superset.begin(), superset.end());
            EXPECT_TRUE(std::includes(superset.begin(), superset.end(), expected.begin(), expected.end()));
        }
}

TEST(SurfaceProximity, FollowsTheVerticesWhenTheyMove)
{
    TriangleMesh mesh = noisy_sphere();
    SurfaceProximity surface(mesh.triangles, mesh.positions);
    for (Vec3& x : mesh.positions)
        x = Vec3(0.4 * x.y() - 1.0, 2.0 * x.x(), x.z() + 0.3 * x.y());
    surface.update(mesh.positions);
    for (const Vec3& p : random_points(11, 300, bounds(mesh.positions).center(), 0.6))
        EXPECT_EQ(surface.closest(p)->triangle, closest_by_brute_force(mesh, p));
}

/// Wedge of 20 degrees with a needle tip, where single face normals give the wrong side.
TriangleMesh sharp_mesh()
{
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0.1, 0.1}, {1, -0.1, 0.1}, {1, 0.1, -0.15}, {1.5, 0, 0}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {4, 1, 2}, {4, 3, 1}, {4, 2, 3}};
    return mesh;
}

TEST(SurfaceProximity, HasCorrectSignsAtSharpEdgesAndTips)
{
    for (const TriangleMesh& mesh : {sharp_mesh(), box_mesh(Vec3::Zero(), Vec3::Ones()), noisy_sphere()}) {
        const SurfaceProximity surface(mesh.triangles, mesh.positions);
        RayScene rays;
        rays.add(mesh.positions, mesh.triangles);
        rays.commit();
        const Bounds box = bounds(mesh.positions);
        int inside_count = 0, vertex_count = 0, edge_count = 0;
        for (const Vec3& p : random_points(12, 8000, box.center(), 0.5 * box.diagonal())) {
            const SurfacePoint found = *surface.closest(p);
            if (found.distance() < 1e-5)
                continue;
            const bool inside = rays.winding_number(p) > 0;
            ASSERT_EQ(found.signed_distance < 0.0, inside) << p.transpose();
            EXPECT_NEAR(found.normal.norm(), 1.0, 1e-12);
            inside_count += inside;
            vertex_count += vertex_of(found.feature) >= 0;
            edge_count += edge_of(found.feature) >= 0;
        }
        EXPECT_GT(inside_count, 10);
        EXPECT_GT(vertex_count, 10);
        EXPECT_GT(edge_count, 10);
    }
}

TEST(SurfaceProximity, FindsOneLocalMinimumPerSheet)
{
    // Three parallel sheets around the point, whose foot lies on a grid vertex, an edge and in a face.
    TriangleMesh mesh = sheet_mesh(1.0, 10, 0.0);
    mesh = testing::merged(mesh, sheet_mesh(1.03, 10, 0.02));
    mesh = testing::merged(mesh, sheet_mesh(1.0, 10, -0.03));
    const SurfaceProximity surface(mesh.triangles, mesh.positions);
    std::vector<SurfacePoint> found;
    for (const Vec3& foot :
         {Vec3(0.1, 0, 0.1), Vec3(0.05, 0, 0.05), Vec3(0.1, 0, 0.03), Vec3(0.013, 0, 0.21)}) {
        surface.local_closest(foot + Vec3(0, 0.005, 0), 0.05, found);
        ASSERT_EQ(found.size(), 3u) << foot.transpose();
        EXPECT_NEAR(found[0].signed_distance, 0.005, 1e-14);
        EXPECT_NEAR(found[1].signed_distance, -0.015, 1e-14);
        EXPECT_NEAR(found[2].signed_distance, 0.035, 1e-14);
        surface.local_closest(foot + Vec3(0, 0.005, 0), 0.02, found);
        EXPECT_EQ(found.size(), 2u);
    }
}

TEST(SurfaceProximity, IsFiniteOnCollapsedTriangles)
{
    TriangleMesh mesh = sphere_mesh(Vec3::Zero(), 0.5, 2);
    SurfaceProximity surface(mesh.triangles, mesh.positions);
    for (Vec3& x : mesh.positions)
        x = x.x() > 0 ? Vec3(0.5, 0.0, 0.0) : Vec3(x.x(), 0.0, 0.0);
    surface.update(mesh.positions);
    std::vector<SurfacePoint> local;
    for (const Vec3& p :
         {Vec3(0, 0, 0), Vec3(0.5, 0, 0), Vec3(0.7, 0.1, 0), Vec3(-0.5, 0, 0), Vec3(-0.2, 0.1, 0.1)}) {
        const SurfacePoint found = *surface.closest(p);
        EXPECT_TRUE(found.point.allFinite() && found.barycentric.allFinite());
        EXPECT_NEAR(found.normal.norm(), 1.0, 1e-12);
        surface.local_closest(p, 0.2, local);
        for (const SurfacePoint& item : local)
            EXPECT_NEAR(item.normal.norm(), 1.0, 1e-12);
    }
}

TEST(SurfaceProximity, GivesTheSameBitsForEveryThreadCount)
{
    const TriangleMesh mesh = noisy_sphere();
    const std::vector<Vec3> points = random_points(13, 2000, Vec3(0.5, 1.5, -0.7), 0.4);
    std::vector<double> reference;
    for (const int threads : {1, 2, 4}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        SurfaceProximity surface(mesh.triangles, mesh.positions);
        surface.update(mesh.positions);
        std::vector<double> answers(points.size());
        parallel_for(kCpu, "test", int(points.size()), [&](int i) {
            const SurfacePoint found = *surface.closest(points[i]);
            answers[i] = found.signed_distance + found.triangle + found.normal.sum() + found.barycentric.x();
        });
        if (threads == 1)
            reference = answers;
        EXPECT_EQ(answers, reference) << threads;
    }
}

TEST(SurfaceProximity, MatchesTheWindingNumberOfARealBody)
{
    const std::filesystem::path file = std::filesystem::path(TOILE_DATA_DIR) / "bodies/smpl_f_template.obj";
    if (!std::filesystem::exists(file))
        GTEST_SKIP() << "SKIPPED: TOILE_DATA_DIR has no bodies/smpl_f_template.obj";
    const TriangleMesh body = read_obj(file).triangulated();
    const SurfaceProximity surface(body.triangles, body.positions);
    RayScene rays;
    rays.add(body.positions, body.triangles);
    rays.commit();
    EXPECT_TRUE(surface.edges().is_closed);
    // The body intersects itself in some regions. Inside one part the closest sheet may be the buried outside
    // of another; outside the body the sign is unambiguous.
    int inside = 0, outside = 0, wrong_inside = 0, wrong_outside = 0;
    for (const Vec3& p : random_points(14, 20000, Vec3(0, -0.2, 0), 0.6)) {
        const std::optional<SurfacePoint> found = surface.closest(p, 0.1);
        if (!found || found->distance() < 1e-5)
            continue;
        const int winding = rays.winding_number(p);
        outside += winding == 0;
        inside += winding > 0;
        wrong_outside += winding == 0 && found->signed_distance < 0.0;
        wrong_inside += winding > 0 && found->signed_distance > 0.0;
    }
    EXPECT_GT(inside, 500);
    EXPECT_GT(outside, 500);
    EXPECT_EQ(wrong_outside, 0);
    EXPECT_LT(wrong_inside, inside / 50);
}

} // namespace
} // namespace toile::test
