#include "core/pd/cuda/newton/cluster_hierarchy.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "core/pd/cuda/newton/hessian_pattern.h"

namespace toile::test {

namespace {

/// Grids of vertices with entries between neighbours, one after the other.
struct Grids {
    std::vector<EmbeddedPoint> points;
    std::vector<std::pair<int, int>> couplings;

    void add(int width, int height)
    {
        const int first = int(points.size());
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                EmbeddedPoint p = EmbeddedPoint::Zero();
                p.head<3>() = Vec3(0.01 * x, 0.01 * y, 0.001 * std::sin(0.3 * x));
                points.push_back(p);
                const int v = first + y * width + x;
                if (x > 0)
                    couplings.emplace_back(v - 1, v);
                if (y > 0)
                    couplings.emplace_back(v - width, v);
            }
    }
    BlockMatrix blocks() const { return {int(points.size()), couplings}; }
    SparseMatrix none() const { return SparseMatrix(int(points.size()), int(points.size())); }
    ClusterHierarchy hierarchy() const { return {points, blocks(), none()}; }
};

Grids several()
{
    Grids grids;
    grids.add(50, 60);   // two levels
    grids.add(2, 2);     // no cluster
    grids.add(9, 5);     // one cluster
    grids.add(160, 120); // three levels
    grids.add(1, 1);
    return grids;
}

} // namespace

TEST(ClusterHierarchy, HasEveryVertexOnceInClustersOfOneComponent)
{
    const Grids grids = several();
    const ClusterHierarchy hierarchy = grids.hierarchy();
    const std::set<int> all(hierarchy.vertices().begin(), hierarchy.vertices().end());
    ASSERT_EQ(all.size(), grids.points.size());
    ASSERT_EQ(hierarchy.vertices().size(), grids.points.size());
    for (int c = 0; c < hierarchy.cluster_count(); ++c) {
        const int size = hierarchy.first_vertex()[c + 1] - hierarchy.first_vertex()[c];
        EXPECT_GT(size, 0);
        EXPECT_LE(size, ClusterHierarchy::kClusterSize);
        for (int k = hierarchy.first_vertex()[c]; k < hierarchy.first_vertex()[c + 1]; ++k)
            EXPECT_EQ(hierarchy.cluster_of()[hierarchy.vertices()[k]], c);
    }
    ASSERT_EQ(hierarchy.levels().size(), 3u);
    EXPECT_EQ(hierarchy.levels()[0].cluster_count, hierarchy.cluster_count() - 1); // the small ones have none
    EXPECT_EQ(hierarchy.levels()[1].cluster_count, 3 + 19);
    EXPECT_EQ(hierarchy.levels()[2].cluster_count, 2);
}

TEST(ClusterHierarchy, HasBlocksOfTheChildrenOfOneParent)
{
    const ClusterHierarchy hierarchy = several().hierarchy();
    for (size_t l = 0; l < hierarchy.levels().size(); ++l) {
        const ClusterHierarchy::Level& level = hierarchy.levels()[l];
        for (int c = 0; c < hierarchy.cluster_count(); ++c) {
            const int cluster = level.cluster_of[c];
            if (cluster < 0)
                continue;
            EXPECT_GE(c, level.first_of_cluster[cluster]);
            EXPECT_LT(c, level.end_of_cluster[cluster]);
            if (l + 1 == hierarchy.levels().size())
                continue;
            for (int d = 0; d < hierarchy.cluster_count(); ++d)
                if (const int other = level.cluster_of[d];
                    other >= 0 && level.block_of[other] == level.block_of[cluster]) {
                    const ClusterHierarchy::Level& above = hierarchy.levels()[l + 1];
                    EXPECT_EQ(above.cluster_of[c], above.cluster_of[d]);
                }
        }
        for (int b = 0; b < level.block_count(); ++b) {
            EXPECT_LE(level.first_of_block[b + 1] - level.first_of_block[b], ClusterHierarchy::kChildren);
            for (int k = level.first_of_block[b]; k < level.first_of_block[b + 1]; ++k) {
                EXPECT_EQ(level.block_of[k], b);
                EXPECT_EQ(level.slot_of[k], k - level.first_of_block[b]);
            }
        }
    }
}

/// A translation, and stretch in the plane, are combinations of every level's functions.
TEST(ClusterHierarchy, RepresentsAffineFieldsOnEveryLevel)
{
    Grids grids;
    grids.add(70, 50);
    for (EmbeddedPoint& p : grids.points)
        p[2] = 0.0;
    const ClusterHierarchy hierarchy = grids.hierarchy();
    ASSERT_EQ(hierarchy.levels().size(), 2u);
    for (const ClusterHierarchy::Level& level : hierarchy.levels())
        for (int cluster = 0; cluster < level.cluster_count; ++cluster) {
            std::vector<int> members;
            for (int c = level.first_of_cluster[cluster]; c < level.end_of_cluster[cluster]; ++c)
                for (int k = hierarchy.first_vertex()[c]; k < hierarchy.first_vertex()[c + 1]; ++k)
                    members.push_back(hierarchy.vertices()[k]);
            Eigen::MatrixXd functions(members.size(), 3), fields(members.size(), 3);
            for (int k = 0; k < int(members.size()); ++k) {
                const int v = members[k];
                const auto& T = level.transfer[hierarchy.cluster_of()[v]].entry;
                for (int b = 0; b < 3; ++b) {
                    functions(k, b) = 0.0;
                    for (int a = 0; a < 3; ++a)
                        functions(k, b) += double(T[a][b]) * double(hierarchy.functions()[v][a]);
                }
                fields.row(k) << 1.0, grids.points[v][0], grids.points[v][1];
            }
            EXPECT_TRUE((functions.transpose() * functions).isIdentity(1e-5));
            const Eigen::MatrixXd rest = fields - functions * (functions.transpose() * fields);
            EXPECT_LT(rest.norm(), 1e-5 * fields.norm());
        }
}

TEST(HessianPattern, FindsEveryEntryAndNoOther)
{
    const Grids grids = several();
    const int n = int(grids.points.size());
    SparseMatrix isotropic(n, n);
    isotropic.insert(0, 0) = 9.0;
    isotropic.insert(0, 100) = 2.5;
    isotropic.insert(100, 0) = 2.5;
    isotropic.makeCompressed();
    const HessianPattern pattern(grids.blocks(), isotropic);
    std::set<int> positions;
    for (const auto& [i, j] : grids.couplings)
        for (const auto& [row, column] : {std::pair{i, j}, {j, i}}) {
            const int at = pattern.block_position(row, column);
            ASSERT_GE(at, 0);
            EXPECT_EQ(pattern.blocks().columns()[at], column);
            EXPECT_TRUE(positions.insert(at).second);
        }
    EXPECT_EQ(pattern.block_position(0, 0), -1);
    EXPECT_EQ(pattern.block_position(0, 3), -1);
    EXPECT_EQ(pattern.scalar_position(0, 0), -1);
    EXPECT_EQ(pattern.constant_scalars()[pattern.scalar_position(100, 0)], 2.5F);
}

} // namespace toile::test
