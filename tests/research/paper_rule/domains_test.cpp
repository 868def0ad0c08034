#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include "research/benchmarks/quadrature/sheet.h"
#include "research/paper_rule/far_clusters.h"
#include "research/paper_rule/near_samples.h"
#include "tests/core/mesh/meshes.h"

namespace toile::test {

using namespace research;

namespace {

constexpr int kPixels = 40;

/// Sheet without its upper right quarter: not convex.
Sheet l_shape(int side)
{
    Sheet whole = unit_sheet(side), part;
    std::vector<int> new_index(whole.vertex_count(), -1);
    for (const Triangle& t : whole.triangles) {
        const Vec2 center = (whole.uv[t[0]] + whole.uv[t[1]] + whole.uv[t[2]]) / 3.0;
        if (center.x() > 0.5 && center.y() > 0.5)
            continue;
        for (const int vertex : t)
            if (new_index[vertex] < 0) {
                new_index[vertex] = part.vertex_count();
                part.uv.push_back(whole.uv[vertex]);
            }
        part.triangles.push_back({new_index[t[0]], new_index[t[1]], new_index[t[2]]});
    }
    return part;
}

/// exp(-distance / 0.1), a model of a kernel row.
std::vector<double> decaying_from(const Sheet& sheet, int vertex)
{
    std::vector<double> u;
    for (const Vec2& point : sheet.uv)
        u.push_back(std::exp(-10.0 * (point - sheet.uv[vertex]).norm()));
    return u;
}

/// Fraction of the influence in the box, pixel by pixel.
double fraction_in(const UvSurface& surface, const PixelBox& box, const std::vector<double>& u)
{
    double inside = 0.0, total = 0.0;
    for (int pixel = 0; pixel < surface.grid().count(); ++pixel)
        for (SparseMatrix::InnerIterator entry(surface.coverage(), pixel); entry; ++entry) {
            total += entry.value() * u[entry.col()];
            if (box.contains(surface.grid().at(pixel)))
                inside += entry.value() * u[entry.col()];
        }
    return inside / total;
}

TEST(UvSurface, CoverageSumsToTheAreas)
{
    const Sheet sheet = unit_sheet(17, 0.3);
    const UvSurface surface(sheet.uv, sheet.triangles, 23);
    const Eigen::VectorXd sums =
        surface.coverage().transpose() * Eigen::VectorXd::Ones(surface.grid().count());
    for (int k = 0; k < sheet.vertex_count(); ++k) {
        EXPECT_NEAR(sums[k], sheet.area[k], 1e-15);
        EXPECT_NEAR(surface.area(k), sheet.area[k], 1e-15);
    }
}

TEST(UvSurface, LocatesPointsInTheirTriangles)
{
    const Sheet sheet = l_shape(21);
    const UvSurface surface(sheet.uv, sheet.triangles, 31);
    for (const Vec2& point : {Vec2(0.31, 0.77), Vec2(0.0, 0.0), Vec2(1.0, 0.5), Vec2(0.123, 0.456)}) {
        const auto located = surface.locate(point);
        ASSERT_TRUE(located);
        Vec2 back = Vec2::Zero();
        for (int corner = 0; corner < 3; ++corner)
            back += located->weight[corner] * sheet.uv[located->vertex[corner]];
        EXPECT_LT((back - point).norm(), 1e-12);
        EXPECT_GE(located->weight.minCoeff(), 0.0);
    }
    EXPECT_FALSE(surface.locate(Vec2(0.7, 0.7)));
    EXPECT_FALSE(surface.locate(Vec2(-0.2, 0.5)));
}

TEST(UvSurface, NamesTheDefectOfAMesh)
{
    const auto message = [](std::vector<Vec2> uv, std::vector<Triangle> triangles) {
        return message_of([&] { UvSurface surface(uv, triangles, 8); });
    };
    const std::vector<Vec2> uv{{0, 0}, {1, 0}, {0, 1}};
    EXPECT_EQ(message(uv, {}), "paper rule: no triangle");
    EXPECT_EQ(message(uv, {{0, 1, 3}}), "paper rule: triangle 0 names a vertex outside of 0..2");
    EXPECT_EQ(message(uv, {{0, 1, 2}, {0, 2, 1}}),
              "paper rule: triangle 1 is flipped or has no area in the UV plane");
    EXPECT_EQ(message({{0, 0}, {1, 0}, {0, 1}, {1, 1}}, {{0, 1, 2}}),
              "paper rule: vertex 3 belongs to no triangle");
    EXPECT_NE(message({{0, 0}, {NAN, 0}, {0, 1}}, {{0, 1, 2}}).find("UV of vertex 1"), std::string::npos);
}

TEST(FieldDomains, AreNestedAndHoldTheirFractions)
{
    const Sheet sheet = unit_sheet(41, 0.2);
    const UvSurface surface(sheet.uv, sheet.triangles, kPixels);
    for (const double k : {10.0, 100.0, 1e4})
        for (const int vertex : {0, 20, 41 * 7 + 3, 41 * 20 + 20}) {
            SCOPED_TRACE("k = " + std::to_string(k) + ", vertex " + std::to_string(vertex));
            const std::vector<double> u = kernel_row(sheet_matrix(sheet, k), vertex);
            const FieldDomains domains = field_domains(surface, vertex, u, {});
            EXPECT_TRUE(domains.near.contains(surface.pixel_of(vertex)));
            for (int axis = 0; axis < 2; ++axis) {
                EXPECT_GE(domains.near.first[axis], domains.middle.first[axis]);
                EXPECT_LE(domains.near.last[axis], domains.middle.last[axis]);
            }
            // At most one slice of pixels above the fraction.
            EXPECT_GE(fraction_in(surface, domains.near, u), 0.7 - 1e-12);
            EXPECT_LT(fraction_in(surface, domains.near, u), 0.8);
            EXPECT_GE(fraction_in(surface, domains.middle, u), 0.9 - 1e-12);
            EXPECT_LT(fraction_in(surface, domains.middle, u), 0.95);
        }
}

TEST(FieldDomains, StayOnTheSurface)
{
    const Sheet sheet = l_shape(41);
    const UvSurface surface(sheet.uv, sheet.triangles, kPixels);
    for (int vertex = 0; vertex < sheet.vertex_count(); vertex += 17) {
        const PixelBox middle = field_domains(surface, vertex, decaying_from(sheet, vertex), {}).middle;
        for (int row = middle.first[1]; row <= middle.last[1]; ++row)
            for (int column = middle.first[0]; column <= middle.last[0]; ++column)
                EXPECT_FALSE(column >= kPixels / 2 && row >= kPixels / 2) << column << " " << row;
    }
}

TEST(FieldDomains, GrowToOneSideFirst)
{
    const Sheet sheet = unit_sheet(41);
    const UvSurface surface(sheet.uv, sheet.triangles, kPixels);
    const int vertex = 41 * 20 + 20;
    DomainSettings settings;
    settings.near_influence = 0.2; // a quarter of the plane contains enough
    settings.only_first_side = true;
    const PixelBox near = field_domains(surface, vertex, decaying_from(sheet, vertex), settings).near;
    const Pixel pixel = surface.pixel_of(vertex);
    EXPECT_EQ(near.first[0], pixel[0]);
    EXPECT_GT(near.last[0], pixel[0] + 3);
}

TEST(NearSamples, StartAtTheVertexAndSpread)
{
    const Sheet sheet = unit_sheet(21);
    const UvSurface surface(sheet.uv, sheet.triangles, 20);
    const PixelBox near{{4, 4}, {12, 12}};
    const int vertex = 21 * 8 + 8;
    const std::vector<int> samples = near_samples(surface, near, vertex, 8);
    ASSERT_EQ(samples.size(), 8u);
    EXPECT_EQ(samples[0], vertex);
    EXPECT_EQ(std::set<int>(samples.begin(), samples.end()).size(), 8u);
    for (size_t a = 0; a < samples.size(); ++a)
        for (size_t b = 0; b < a; ++b)
            EXPECT_GT((sheet.uv[samples[a]] - sheet.uv[samples[b]]).norm(), 0.15);
    EXPECT_EQ(near_samples(surface, {{4, 4}, {4, 4}}, 21 * 4 + 4, 8).size(), 1u);
}

TEST(FarClusters, ApportionTheFarFieldsArea)
{
    const Sheet sheet = unit_sheet(31, 0.2);
    const UvSurface surface(sheet.uv, sheet.triangles, kPixels);
    const int vertex = 31 * 15 + 15;
    const std::vector<double> u = decaying_from(sheet, vertex);
    const PixelBox middle{{10, 10}, {29, 29}};
    const std::vector<FarCluster> clusters = far_clusters(surface, middle, u, 8, 3);
    EXPECT_EQ(clusters.size(), 8u);
    double expected = 0.0, sum = 0.0;
    for (int k = 0; k < sheet.vertex_count(); ++k)
        expected += middle.contains(surface.pixel_of(k)) ? 0.0 : sheet.area[k];
    for (const FarCluster& cluster : clusters) {
        EXPECT_FALSE(middle.contains(surface.pixel_of(cluster.vertex)));
        sum += cluster.area;
    }
    EXPECT_NEAR(sum, expected, 1e-12);
}

TEST(FarClusters, AreTheSameForTheSameSeed)
{
    const Sheet sheet = unit_sheet(31);
    const UvSurface surface(sheet.uv, sheet.triangles, kPixels);
    const std::vector<double> u = decaying_from(sheet, 0);
    const auto vertices = [&](unsigned seed) {
        std::vector<int> list;
        for (const FarCluster& cluster : far_clusters(surface, {{0, 0}, {9, 9}}, u, 8, seed))
            list.push_back(cluster.vertex);
        return list;
    };
    EXPECT_EQ(vertices(1), vertices(1));
    EXPECT_NE(vertices(1), vertices(2));
}

TEST(FarClusters, KeepToOneComponentEach)
{
    // A band of middle pixels cuts the sheet into a third and two thirds.
    const Sheet sheet = unit_sheet(31);
    const UvSurface surface(sheet.uv, sheet.triangles, 30);
    const std::vector<double> u = decaying_from(sheet, 31 * 15 + 10);
    int left = 0;
    const std::vector<FarCluster> clusters = far_clusters(surface, {{8, 0}, {11, 29}}, u, 8, 1);
    EXPECT_EQ(clusters.size(), 8u);
    for (const FarCluster& cluster : clusters)
        left += sheet.uv[cluster.vertex].x() < 0.3;
    EXPECT_GE(left, 2);
    EXPECT_LE(left, 3);
    EXPECT_TRUE(far_clusters(surface, {{0, 0}, {29, 29}}, u, 8, 1).empty());
}

} // namespace
} // namespace toile::test
