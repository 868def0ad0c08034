#include "garment/pattern/mesh/resampling.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "garment/pattern/mesh/sewn_mesh.h"
#include "tests/garment/pattern/mesh/patterns.h"

namespace toile::garment::test {

namespace {

TEST(Resample, ReproducesLinearFunctions)
{
    const Pattern pattern = tee();
    const PatternMesh coarse = mesh_pattern(pattern, {0.04, {}, {}}),
                      fine = mesh_pattern(pattern, {0.013, {}, {}});
    const Resampling resampling = resample(coarse, fine);
    const auto linear = [](const Vec2& x) { return 3.0 * x.x() - 2.0 * x.y() + 0.7; };
    std::vector<double> values;
    for (const Vec2& x : coarse.uv)
        values.push_back(linear(x));
    const std::vector<double> result = resampling.apply(coarse, values);
    for (int v = 0; v < fine.vertex_count(); ++v) {
        EXPECT_NEAR(result[v], linear(fine.uv[v]), 1e-13);
        EXPECT_GE(resampling.weights[v].minCoeff(), 0.0);
        EXPECT_NEAR(resampling.weights[v].sum(), 1.0, 1e-15);
        EXPECT_EQ(coarse.panel_of_triangle(resampling.triangle[v]), fine.panel_of_vertex(v));
    }
}

TEST(Resample, IsTheIdentityOnTheSameMesh)
{
    const PatternMesh mesh = mesh_pattern(pattern_of(half_ring("skirt", 0.1, 0.4)), {0.03, {}, {}});
    const std::vector<Vec2> result = resample(mesh, mesh).apply(mesh, mesh.uv);
    for (int v = 0; v < mesh.vertex_count(); ++v)
        EXPECT_LT((result[v] - mesh.uv[v]).norm(), 1e-15);
}

TEST(Resample, TakesTheNearestPointBeyondACoarseOutline)
{
    // Fine vertices of a disc lie up to a sagitta outside of the coarse polygon.
    const Pattern pattern = pattern_of(disc("patch", 0.2));
    const PatternMesh coarse = mesh_pattern(pattern, {0.08, {}, {}}),
                      fine = mesh_pattern(pattern, {0.01, {}, {}});
    const double sagitta = 0.2 - 0.2 * std::cos(std::asin(0.5 * 0.08 / 0.2));
    const std::vector<Vec2> result = resample(coarse, fine).apply(coarse, coarse.uv);
    double largest = 0.0;
    for (int v = 0; v < fine.vertex_count(); ++v)
        largest = std::max(largest, (result[v] - fine.uv[v]).norm());
    EXPECT_LT(largest, 1.3 * sagitta);
    EXPECT_GT(largest, 0.5 * sagitta) << "the test has such vertices";
}

TEST(Resample, FindsTheNearestTriangleAsASearchOfAllDoes)
{
    const Pattern pattern = pattern_of(polygon(
        "u", {{0.0, 0.0}, {0.5, 0.0}, {0.5, 0.5}, {0.27, 0.5}, {0.25, 0.1}, {0.23, 0.5}, {0.0, 0.5}}));
    const PatternMesh coarse = mesh_pattern(pattern, {0.07, {}, {}}),
                      fine = mesh_pattern(pattern, {0.02, {}, {}});
    const Resampling resampling = resample(coarse, fine);
    for (int v = 0; v < fine.vertex_count(); ++v) {
        const Triangle& t = coarse.triangles[resampling.triangle[v]];
        Vec2 x = Vec2::Zero();
        for (int k = 0; k < 3; ++k)
            x += resampling.weights[v][k] * coarse.uv[t[k]];
        EXPECT_LT((x - fine.uv[v]).norm(), 1e-14) << "straight edges: every fine vertex is covered";
    }
}

TEST(Resample, KeepsSeamsClosed)
{
    // Sides of different lengths and a T-seam, sewn in the coarse mesh.
    Pattern pattern = front_and_back(half_ring("front", 0.1, 0.4), {1, 3});
    pattern.panels.push_back(rectangle("band", 0.5, 0.04));
    pattern.seams.push_back(
        {{{2, 0, 0.0, 0.45}, {2, 0, 0.45, 0.9}}, {{0, 2, 0.0, 1.0}, {1, 1, 0.0, 1.0}}, "waist", {}});
    const PatternMesh coarse = mesh_pattern(pattern, {0.04, {}, {}}),
                      fine = mesh_pattern(pattern, {0.011, {}, {}});
    const SewnMesh sewn = sewn_mesh(coarse);
    std::vector<Vec3> positions(coarse.vertex_count());
    for (int v = 0; v < coarse.vertex_count(); ++v) {
        const double at = sewn.welded_of[v];
        positions[v] = Vec3(std::sin(at), std::sin(1.7 * at), std::cos(2.3 * at));
    }
    const std::vector<Vec3> result = resample(coarse, fine).apply(coarse, positions);
    int pairs = 0;
    for (const auto& seam : fine.stitches)
        for (const auto& [a, b] : seam) {
            EXPECT_LT((result[a] - result[b]).norm(), 1e-11);
            ++pairs;
        }
    EXPECT_GT(pairs, 100);
}

TEST(Resample, RefusesMeshesOfDifferentPatterns)
{
    const PatternMesh a = mesh_pattern(tee(), {0.05, {}, {}}), b = mesh_pattern(trousers(), {0.05, {}, {}});
    EXPECT_THROW(resample(a, b), InvalidUse);
}

} // namespace

} // namespace toile::garment::test
