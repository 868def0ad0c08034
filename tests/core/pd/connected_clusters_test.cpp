#include "core/pd/newton/connected_clusters.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

namespace toile::test {

namespace {

constexpr int kWidth = 4;

/// Links of both directions.
Links links_of(int items, const std::vector<std::pair<int, int>>& pairs)
{
    const SparseMatrix none(items, items);
    return toile::links_of(BlockMatrix(items, pairs), none, std::vector<unsigned char>(items, 0));
}

/// A strip of `length` rows that is folded in the middle, with 1 mm between its halves and 1 cm between rows.
struct Hairpin {
    std::vector<EmbeddedPoint> points;
    std::vector<std::pair<int, int>> pairs;

    explicit Hairpin(int length)
    {
        for (int row = 0; row < length; ++row)
            for (int k = 0; k < kWidth; ++k) {
                const bool is_back = 2 * row >= length;
                EmbeddedPoint p = EmbeddedPoint::Zero();
                p.head<3>() =
                    Vec3(0.01 * (is_back ? length - 1 - row : row), 0.01 * k, is_back ? 0.001 : 0.0);
                points.push_back(p);
                const int v = kWidth * row + k;
                if (k > 0)
                    pairs.emplace_back(v - 1, v);
                if (row > 0)
                    pairs.emplace_back(v - kWidth, v);
            }
    }
    Links links() const { return links_of(int(points.size()), pairs); }
};

/// Connected pieces of some vertices.
int pieces(const Links& links, const std::vector<int>& vertices)
{
    std::vector<unsigned char> excluded(links.count(), 1);
    for (const int v : vertices)
        excluded[v] = 0;
    return int(connected_components(links, excluded).size());
}

} // namespace

TEST(ConnectedClusters, DoNotJoinTheSidesOfAFold)
{
    const Hairpin hairpin(200);
    const Links links = hairpin.links();
    const int count = int(hairpin.points.size());
    std::vector<int> all(count);
    std::iota(all.begin(), all.end(), 0);
    const ClusterTree tree(hairpin.points, all, Extent::Volume);
    const std::vector<int> first(tree.nodes().begin(), tree.nodes().begin() + ConnectedClusters::kSize);
    ASSERT_EQ(pieces(links, first), 2); // near each other in space

    const ConnectedClusters clusters(hairpin.points, links, std::vector<unsigned char>(count, 0),
                                     Extent::Volume);
    std::vector<int> seen;
    for (const std::vector<int>& vertices : clusters.vertices()) {
        EXPECT_EQ(pieces(links, vertices), 1);
        EXPECT_LE(int(vertices.size()), ConnectedClusters::kSize);
        EXPECT_GE(int(vertices.size()), ConnectedClusters::kSize / 4);
        seen.insert(seen.end(), vertices.begin(), vertices.end());
    }
    std::sort(seen.begin(), seen.end());
    EXPECT_EQ(seen, all);
    EXPECT_TRUE(clusters.others.empty());
    EXPECT_EQ(clusters.first_of_component, (std::vector<int>{0, clusters.count()}));
}

TEST(ConnectedClusters, LeaveOutWhatIsExcludedAndSmallComponents)
{
    const Hairpin hairpin(40);
    std::vector<unsigned char> excluded(hairpin.points.size(), 0);
    for (int k = 0; k < kWidth; ++k) // leaves one row at the end
        excluded[kWidth + k] = 1;
    const Links links = toile::links_of(BlockMatrix(int(hairpin.points.size()), hairpin.pairs),
                                        SparseMatrix(160, 160), excluded);
    const ConnectedClusters clusters(hairpin.points, links, excluded, Extent::Volume);
    EXPECT_EQ(clusters.others, (std::vector<int>{0, 1, 2, 3}));
    for (int v = 0; v < int(excluded.size()); ++v)
        EXPECT_EQ(clusters.groups.of[v] < 0, v < 2 * kWidth);
}

TEST(ConnectedGroups, SmallOnesJoinTheirClosestNeighbour)
{
    // 0-1-2-3 | 4 | 5-6-7: item 4 has two links to the last group, and one to the first.
    const Links links = links_of(8, {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}, {4, 6}, {5, 6}, {6, 7}});
    const std::vector<int> labels{5, 5, 5, 5, 3, 1, 1, 1}, ones(8, 1);
    const Groups groups = connected_groups(links, labels, ones, 2, 10);
    EXPECT_EQ(groups.of, (std::vector<int>{1, 1, 1, 1, 0, 0, 0, 0}));
    EXPECT_EQ(groups.label, (std::vector<int>{1, 5}));
    EXPECT_EQ(sums_of(groups, ones), (std::vector<int>{4, 4}));
    EXPECT_EQ(links_between(links, groups).to, (std::vector<int>{1, 0}));

    EXPECT_EQ(connected_groups(links, labels, ones, 2, 3).count(), 3) << "no group has room";
}

TEST(ConnectedGroups, OneLabelMakesAGroupForEachPiece)
{
    const Links links = links_of(5, {{0, 1}, {2, 3}, {3, 4}});
    const Groups groups =
        connected_groups(links, std::vector<int>{7, 7, 7, -1, 7}, std::vector<int>(5, 1), 0, 9);
    EXPECT_EQ(groups.of, (std::vector<int>{0, 0, 1, -1, 2}));
}

TEST(ConnectedGroups, AreJoinedToANumberTheLightestFirst)
{
    // A path of groups of weights 4, 1, 2, 3, and one group that is linked to none.
    const Links links =
        links_of(11, {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 6}, {6, 7}, {7, 8}, {8, 9}});
    const Groups groups{{0, 0, 0, 0, 1, 2, 2, 3, 3, 3, 4}, {10, 11, 12, 13, 14}};
    const std::vector<int> ones(11, 1);
    const auto joined = [&](int count, int largest) {
        return joined_groups(links, groups, ones, count, largest);
    };
    EXPECT_EQ(joined(5, 11).of, groups.of);
    EXPECT_EQ(joined(4, 11).of, (std::vector<int>{0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 3}));
    EXPECT_EQ(joined(4, 11).label, (std::vector<int>{10, 12, 13, 14}));
    EXPECT_EQ(sums_of(joined(3, 11), ones), (std::vector<int>{4, 6, 1}));
    EXPECT_EQ(joined(1, 11).count(), 2) << "what nothing links stays apart";
    EXPECT_EQ(joined(1, 3).count(), 4) << "no larger group has room";
}

TEST(AffineFunctions, AreOrthonormalAndZeroWhereTheyDepend)
{
    const Hairpin hairpin(10); // of the first half, all vertices lie in a plane
    std::vector<int> half(20);
    std::iota(half.begin(), half.end(), 0);
    const Eigen::MatrixXd functions = affine_functions(hairpin.points, half, Extent::Volume);
    Eigen::Matrix4d expected = Eigen::Matrix4d::Identity();
    expected(3, 3) = 0.0;
    EXPECT_LT((functions.transpose() * functions - expected).norm(), 1e-12);
}

} // namespace toile::test
