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

constexpr int kVoxels = 40;

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

/// Fraction of the influence in the box, voxel by voxel.
double fraction_in(const VoxelisedMesh<2>& mesh, const VoxelBox<2>& box, const std::vector<double>& u)
{
    double inside = 0.0, total = 0.0;
    for (int voxel = 0; voxel < mesh.grid().count(); ++voxel)
        for (SparseMatrix::InnerIterator entry(mesh.coverage(), voxel); entry; ++entry) {
            total += entry.value() * u[entry.col()];
            if (box.contains(mesh.grid().at(voxel)))
                inside += entry.value() * u[entry.col()];
        }
    return inside / total;
}

TEST(VoxelisedMesh, CoverageSumsToTheAreas)
{
    const Sheet sheet = unit_sheet(17, 0.3);
    const VoxelisedMesh<2> mesh(sheet.uv, sheet.triangles, 23);
    const Eigen::VectorXd sums = mesh.coverage().transpose() * Eigen::VectorXd::Ones(mesh.grid().count());
    for (int k = 0; k < sheet.vertex_count(); ++k) {
        EXPECT_NEAR(sums[k], sheet.area[k], 1e-15);
        EXPECT_NEAR(mesh.volume(k), sheet.area[k], 1e-15);
    }
}

TEST(VoxelisedMesh, LocatesPointsInTheirTriangles)
{
    const Sheet sheet = l_shape(21);
    const VoxelisedMesh<2> mesh(sheet.uv, sheet.triangles, 31);
    for (const Vec2& point : {Vec2(0.31, 0.77), Vec2(0.0, 0.0), Vec2(1.0, 0.5), Vec2(0.123, 0.456)}) {
        const auto located = mesh.locate(point);
        ASSERT_TRUE(located);
        Vec2 back = Vec2::Zero();
        for (int corner = 0; corner < 3; ++corner)
            back += located->weight[corner] * sheet.uv[located->vertex[corner]];
        EXPECT_LT((back - point).norm(), 1e-12);
        EXPECT_GE(located->weight.minCoeff(), 0.0);
    }
    EXPECT_FALSE(mesh.locate(Vec2(0.7, 0.7)));
    EXPECT_FALSE(mesh.locate(Vec2(-0.2, 0.5)));
}

TEST(VoxelisedMesh, NamesTheDefectOfAMesh)
{
    const auto message = [](std::vector<Vec2> uv, std::vector<Triangle> triangles) {
        return message_of([&] { VoxelisedMesh<2> mesh(uv, triangles, 8); });
    };
    const std::vector<Vec2> uv{{0, 0}, {1, 0}, {0, 1}};
    EXPECT_EQ(message(uv, {}), "paper rule: no triangle");
    EXPECT_EQ(message(uv, {{0, 1, 3}}), "paper rule: triangle 0 names a vertex outside of 0..2");
    EXPECT_EQ(message(uv, {{0, 1, 2}, {0, 2, 1}}), "paper rule: triangle 1 is inside out or flat");
    EXPECT_EQ(message({{0, 0}, {1, 0}, {0, 1}, {1, 1}}, {{0, 1, 2}}),
              "paper rule: vertex 3 belongs to no triangle");
    EXPECT_NE(message({{0, 0}, {NAN, 0}, {0, 1}}, {{0, 1, 2}}).find("vertex 1 lies at (nan, 0)"),
              std::string::npos);
}

TEST(FieldDomains, AreNestedAndHoldTheirFractions)
{
    const Sheet sheet = unit_sheet(41, 0.2);
    const VoxelisedMesh<2> mesh(sheet.uv, sheet.triangles, kVoxels);
    for (const double k : {10.0, 100.0, 1e4})
        for (const int vertex : {0, 20, 41 * 7 + 3, 41 * 20 + 20}) {
            SCOPED_TRACE("k = " + std::to_string(k) + ", vertex " + std::to_string(vertex));
            const std::vector<double> u = kernel_row(sheet_matrix(sheet, k), vertex);
            const FieldDomains domains = field_domains(mesh, vertex, u, {});
            EXPECT_TRUE(domains.near.contains(mesh.voxel_of(vertex)));
            for (int axis = 0; axis < 2; ++axis) {
                EXPECT_GE(domains.near.first[axis], domains.middle.first[axis]);
                EXPECT_LE(domains.near.last[axis], domains.middle.last[axis]);
            }
            // At most one slice of voxels above the fraction.
            EXPECT_GE(fraction_in(mesh, domains.near, u), 0.7 - 1e-12);
            EXPECT_LT(fraction_in(mesh, domains.near, u), 0.8);
            EXPECT_GE(fraction_in(mesh, domains.middle, u), 0.9 - 1e-12);
            EXPECT_LT(fraction_in(mesh, domains.middle, u), 0.95);
        }
}

TEST(FieldDomains, StayOnTheSurface)
{
    const Sheet sheet = l_shape(41);
    const VoxelisedMesh<2> mesh(sheet.uv, sheet.triangles, kVoxels);
    for (int vertex = 0; vertex < sheet.vertex_count(); vertex += 17) {
        const VoxelBox<2> middle = field_domains(mesh, vertex, decaying_from(sheet, vertex), {}).middle;
        for (int row = middle.first[1]; row <= middle.last[1]; ++row)
            for (int column = middle.first[0]; column <= middle.last[0]; ++column)
                EXPECT_FALSE(column >= kVoxels / 2 && row >= kVoxels / 2) << column << " " << row;
    }
}

TEST(FieldDomains, GrowToOneSideFirst)
{
    const Sheet sheet = unit_sheet(41);
    const VoxelisedMesh<2> mesh(sheet.uv, sheet.triangles, kVoxels);
    const int vertex = 41 * 20 + 20;
    DomainSettings settings;
    settings.near_influence = 0.2; // a quarter of the plane contains enough
    settings.only_first_side = true;
    const VoxelBox<2> near = field_domains(mesh, vertex, decaying_from(sheet, vertex), settings).near;
    const Voxel<2> voxel = mesh.voxel_of(vertex);
    EXPECT_EQ(near.first[0], voxel[0]);
    EXPECT_GT(near.last[0], voxel[0] + 3);
}

TEST(NearSamples, StartAtTheVertexAndSpread)
{
    const Sheet sheet = unit_sheet(21);
    const VoxelisedMesh<2> mesh(sheet.uv, sheet.triangles, 20);
    const VoxelBox<2> near{{4, 4}, {12, 12}};
    const int vertex = 21 * 8 + 8;
    const std::vector<int> samples = near_samples(mesh, near, vertex, 8);
    ASSERT_EQ(samples.size(), 8u);
    EXPECT_EQ(samples[0], vertex);
    EXPECT_EQ(std::set<int>(samples.begin(), samples.end()).size(), 8u);
    for (size_t a = 0; a < samples.size(); ++a)
        for (size_t b = 0; b < a; ++b)
            EXPECT_GT((sheet.uv[samples[a]] - sheet.uv[samples[b]]).norm(), 0.15);
    EXPECT_EQ(near_samples(mesh, VoxelBox<2>{{4, 4}, {4, 4}}, 21 * 4 + 4, 8).size(), 1u);
}

TEST(FarClusters, ApportionTheFarFieldsArea)
{
    const Sheet sheet = unit_sheet(31, 0.2);
    const VoxelisedMesh<2> mesh(sheet.uv, sheet.triangles, kVoxels);
    const int vertex = 31 * 15 + 15;
    const std::vector<double> u = decaying_from(sheet, vertex);
    const VoxelBox<2> middle{{10, 10}, {29, 29}};
    const std::vector<FarCluster> clusters = far_clusters(mesh, middle, u, 8, 3);
    EXPECT_EQ(clusters.size(), 8u);
    double expected = 0.0, sum = 0.0;
    for (int k = 0; k < sheet.vertex_count(); ++k)
        expected += middle.contains(mesh.voxel_of(k)) ? 0.0 : sheet.area[k];
    for (const FarCluster& cluster : clusters) {
        EXPECT_FALSE(middle.contains(mesh.voxel_of(cluster.vertex)));
        sum += cluster.volume;
    }
    EXPECT_NEAR(sum, expected, 1e-12);
}

TEST(FarClusters, AreTheSameForTheSameSeed)
{
    const Sheet sheet = unit_sheet(31);
    const VoxelisedMesh<2> mesh(sheet.uv, sheet.triangles, kVoxels);
    const std::vector<double> u = decaying_from(sheet, 0);
    const auto vertices = [&](unsigned seed) {
        std::vector<int> list;
        for (const FarCluster& cluster : far_clusters(mesh, VoxelBox<2>{{0, 0}, {9, 9}}, u, 8, seed))
            list.push_back(cluster.vertex);
        return list;
    };
    EXPECT_EQ(vertices(1), vertices(1));
    EXPECT_NE(vertices(1), vertices(2));
}

TEST(FarClusters, KeepToOneComponentEach)
{
    // A band of middle voxels cuts the sheet into a third and two thirds.
    const Sheet sheet = unit_sheet(31);
    const VoxelisedMesh<2> mesh(sheet.uv, sheet.triangles, 30);
    const std::vector<double> u = decaying_from(sheet, 31 * 15 + 10);
    int left = 0;
    const std::vector<FarCluster> clusters = far_clusters(mesh, VoxelBox<2>{{8, 0}, {11, 29}}, u, 8, 1);
    EXPECT_EQ(clusters.size(), 8u);
    for (const FarCluster& cluster : clusters)
        left += sheet.uv[cluster.vertex].x() < 0.3;
    EXPECT_GE(left, 2);
    EXPECT_LE(left, 3);
    EXPECT_TRUE(far_clusters(mesh, VoxelBox<2>{{0, 0}, {29, 29}}, u, 8, 1).empty());
}

} // namespace
} // namespace toile::test
