#include "core/pd/cuda/newton/cluster_hierarchy.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
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
    /// A strip of four vertices across whose rows go to and fro, 1 mm apart where it turns.
    void add_folded_strip(int rows)
    {
        constexpr int kAcross = 4, kRowsOfFold = 500;
        for (int row = 0; row < rows; ++row)
            for (int k = 0; k < kAcross; ++k) {
                const int fold = row / kRowsOfFold, along = row % kRowsOfFold;
                EmbeddedPoint p = EmbeddedPoint::Zero();
                p.head<3>() =
                    Vec3(0.01 * (fold % 2 == 0 ? along : kRowsOfFold - 1 - along), 0.01 * k, 0.001 * fold);
                points.push_back(p);
                const int v = int(points.size()) - 1;
                if (k > 0)
                    couplings.emplace_back(v - 1, v);
                if (row > 0)
                    couplings.emplace_back(v - kAcross, v);
            }
    }
    BlockMatrix blocks() const { return {int(points.size()), couplings}; }
    SparseMatrix none() const { return SparseMatrix(int(points.size()), int(points.size())); }
    ClusterHierarchy hierarchy(Extent extent = Extent::Surface) const
    {
        return {points, blocks(), none(), extent};
    }
};

Grids several()
{
    Grids grids;
    grids.add(50, 60);   // three blocks, regions of 128 vertices
    grids.add(2, 2);     // no cluster
    grids.add(9, 5);     // one cluster
    grids.add(160, 120); // 300 clusters
    grids.add(1, 1);
    return grids;
}

int copy_count(const ClusterHierarchy& hierarchy, int cluster)
{
    return hierarchy.first_copy()[cluster + 1] - hierarchy.first_copy()[cluster];
}

std::vector<int> clusters_of_block(const ClusterHierarchy& hierarchy, int block)
{
    std::vector<int> clusters;
    for (int k = hierarchy.first_member()[block]; k < hierarchy.first_member()[block + 1]; ++k)
        clusters.push_back(hierarchy.members()[k].cluster);
    return clusters;
}

std::vector<int> with_neighbours(const ClusterHierarchy& hierarchy, const std::vector<int>& clusters)
{
    std::set<int> all;
    for (const int c : clusters)
        for (int at = hierarchy.first_neighbour()[c]; at < hierarchy.first_neighbour()[c + 1]; ++at)
            all.insert(hierarchy.neighbours()[at]);
    return {all.begin(), all.end()};
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
    EXPECT_EQ(hierarchy.cluster_count(), 47 + 1 + 300 + 1); // the last holds the small components
    EXPECT_EQ(hierarchy.block_count(), 3 + 1 + 21);         // regions of 17 clusters make two blocks
    EXPECT_EQ(copy_count(hierarchy, hierarchy.cluster_count() - 1), 0);
    EXPECT_EQ(hierarchy.component_count(), 2);
    EXPECT_EQ(hierarchy.region_count(), 23 + 85); // the last cluster of 47 joins a region; 85 at most
}

TEST(ClusterHierarchy, HasBlocksAndRegionsOfClustersOfOneComponent)
{
    const ClusterHierarchy hierarchy = several().hierarchy();
    for (int b = 0; b < hierarchy.block_count(); ++b) {
        const std::vector<int> clusters = clusters_of_block(hierarchy, b);
        EXPECT_LE(clusters.size(), size_t(ClusterHierarchy::kBlockClusters));
        EXPECT_TRUE(std::is_sorted(clusters.begin(), clusters.end()));
    }
    for (int c = 0; c < hierarchy.cluster_count(); ++c)
        for (int k = hierarchy.first_copy()[c]; k < hierarchy.first_copy()[c + 1]; ++k) {
            const ClusterHierarchy::Copy copy = hierarchy.copies()[k];
            const ClusterHierarchy::Member member =
                hierarchy.members()[hierarchy.first_member()[copy.block] + copy.place];
            EXPECT_EQ(member.cluster, c);
            EXPECT_EQ(member.copy, k);
        }
    EXPECT_EQ(hierarchy.members().size(), hierarchy.copies().size());
    for (int k = 0; k < hierarchy.component_count(); ++k) {
        const int first = hierarchy.first_region()[k], end = hierarchy.first_region()[k + 1];
        EXPECT_LE(hierarchy.unknown_count() * (end - first), ClusterHierarchy::kMaxUnknowns);
        for (int r = first; r < end; ++r) {
            EXPECT_EQ(hierarchy.component_of()[r], k);
            for (int c = hierarchy.clusters_of_region()[r].first; c < hierarchy.clusters_of_region()[r].end;
                 ++c)
                EXPECT_EQ(hierarchy.region_of()[c], r);
        }
    }
    for (int c = 0; c < hierarchy.cluster_count(); ++c)
        for (int at = hierarchy.first_neighbour()[c]; at < hierarchy.first_neighbour()[c + 1]; ++at) {
            const int d = hierarchy.neighbours()[at];
            EXPECT_EQ(hierarchy.region_of()[c] < 0, hierarchy.region_of()[d] < 0);
            const auto begin = hierarchy.neighbours().begin();
            EXPECT_TRUE(std::binary_search(begin + hierarchy.first_neighbour()[d],
                                           begin + hierarchy.first_neighbour()[d + 1], c));
        }
}

/// A body whose regions consist of several blocks, with folds near each other, beside many small ones.
TEST(ClusterHierarchy, HasConnectedBlocksAndRegionsWhereABodyIsFolded)
{
    Grids grids;
    grids.add_folded_strip(20'000);
    for (int k = 0; k < 27; ++k)
        grids.add(33, 33);
    const ClusterHierarchy hierarchy = grids.hierarchy(Extent::Volume);
    const std::vector<unsigned char> none(grids.points.size(), 0);
    const Links links = links_of(grids.blocks(), grids.none(), none);
    const auto expect_connected = [&](const std::vector<int>& of_clusters) {
        std::vector<unsigned char> excluded(grids.points.size(), 1);
        for (const int c : of_clusters)
            for (int k = hierarchy.first_vertex()[c]; k < hierarchy.first_vertex()[c + 1]; ++k)
                excluded[hierarchy.vertices()[k]] = 0;
        EXPECT_EQ(connected_components(links, excluded).size(), 1U);
    };
    ASSERT_EQ(hierarchy.component_count(), 28);
    EXPECT_EQ(hierarchy.first_region()[1], ClusterHierarchy::kMaxUnknowns / hierarchy.unknown_count())
        << "as many regions as are allowed";
    for (int k = 0; k < hierarchy.component_count(); ++k)
        EXPECT_LE(hierarchy.unknown_count() * (hierarchy.first_region()[k + 1] - hierarchy.first_region()[k]),
                  ClusterHierarchy::kMaxUnknowns);
    for (int b = 0;
         hierarchy.members()[hierarchy.first_member()[b]].cluster < hierarchy.clusters_of_region()[70].first;
         ++b)
        expect_connected(clusters_of_block(hierarchy, b));
    for (int r = 0; r < 70; ++r) {
        const ClusterHierarchy::Range range = hierarchy.clusters_of_region()[r];
        std::vector<int> clusters(range.end - range.first);
        std::iota(clusters.begin(), clusters.end(), range.first);
        expect_connected(clusters);
    }
}

/// Regions of a long strip consist of blocks, which have the clusters next to them; those of a short one, of
/// which blocks consist, do not, and few of a large sheet do, where they are too many.
TEST(ClusterHierarchy, HasOverlappingBlocksWhereALargeBodyIsThin)
{
    Grids long_strip, short_strip, sheet;
    long_strip.add_folded_strip(20'000);
    short_strip.add_folded_strip(4'000);
    sheet.add(400, 400);
    const ClusterHierarchy overlapping = long_strip.hierarchy(Extent::Volume);
    for (int b = 0; b < overlapping.block_count(); ++b) {
        const std::vector<int> clusters = clusters_of_block(overlapping, b);
        std::vector<int> own; // clusters that no other block has
        std::copy_if(clusters.begin(), clusters.end(), std::back_inserter(own),
                     [&](int c) { return copy_count(overlapping, c) == 1; });
        EXPECT_LE(clusters.size(), size_t(ClusterHierarchy::kMaxBlockClusters));
        const std::vector<int> near = with_neighbours(overlapping, own);
        EXPECT_TRUE(std::includes(clusters.begin(), clusters.end(), near.begin(), near.end()));
        EXPECT_GE(clusters.size(), own.size() + 2) << "its own at an end, and the next";
    }
    const ClusterHierarchy disjoint = short_strip.hierarchy(Extent::Volume);
    EXPECT_EQ(int(disjoint.members().size()), disjoint.cluster_count());
    const ClusterHierarchy of_sheet = sheet.hierarchy();
    EXPECT_LT(double(of_sheet.members().size()), 1.3 * of_sheet.cluster_count());
}

TEST(ClusterHierarchy, KnowsTheClustersThatEntriesCouple)
{
    const Grids grids = several();
    const ClusterHierarchy hierarchy = grids.hierarchy();
    std::set<std::pair<int, int>> coupled;
    for (int c = 0; c < hierarchy.cluster_count(); ++c)
        if (copy_count(hierarchy, c) > 0)
            coupled.emplace(c, c);
    for (const auto& [i, j] : grids.couplings) {
        const int c = hierarchy.cluster_of()[i], d = hierarchy.cluster_of()[j];
        if (copy_count(hierarchy, c) == 0)
            continue;
        coupled.emplace(c, d);
        coupled.emplace(d, c);
    }
    std::set<std::pair<int, int>> listed;
    for (int c = 0; c < hierarchy.cluster_count(); ++c)
        for (int at = hierarchy.first_neighbour()[c]; at < hierarchy.first_neighbour()[c + 1]; ++at)
            listed.emplace(c, hierarchy.neighbours()[at]);
    EXPECT_EQ(listed, coupled);
    EXPECT_EQ(listed.size(), hierarchy.neighbours().size());
}

/// A translation, and stretch along the axes of the extent, are combinations of a cluster's functions and of
/// a region's.
void expect_affine_fields(const Grids& grids, Extent extent, int vertices_of_region)
{
    const ClusterHierarchy hierarchy = grids.hierarchy(extent);
    const int rank = rank_of(extent);
    ASSERT_EQ(hierarchy.function_count(), rank);
    ASSERT_NEAR(double(grids.points.size()) / hierarchy.region_count(), vertices_of_region,
                0.1 * vertices_of_region);
    const auto check = [&](int first_cluster, int end_cluster, const auto& value) {
        const int first = hierarchy.first_vertex()[first_cluster],
                  end = hierarchy.first_vertex()[end_cluster];
        Eigen::MatrixXd functions(end - first, rank), fields(end - first, rank);
        for (int k = first; k < end; ++k) {
            const int v = hierarchy.vertices()[k];
            for (int b = 0; b < rank; ++b) {
                functions(k - first, b) = value(v, b);
                fields(k - first, b) = b == 0 ? 1.0 : grids.points[v][b - 1];
            }
        }
        if (end - first >= ConnectedClusters::kSize / 4) // some functions of a few vertices are zero
            EXPECT_TRUE((functions.transpose() * functions).isIdentity(1e-5));
        const Eigen::MatrixXd rest = fields - functions * (functions.transpose() * fields);
        EXPECT_LT(rest.norm(), 1e-5 * fields.norm());
    };
    for (int c = 0; c < hierarchy.cluster_count(); ++c)
        check(c, c + 1, [&](int v, int b) { return double(hierarchy.functions()[v][b]); });
    for (const ClusterHierarchy::Range& range : hierarchy.clusters_of_region())
        check(range.first, range.end, [&](int v, int b) {
            const auto& T = hierarchy.transfers()[hierarchy.cluster_of()[v]].entry;
            double sum = 0.0;
            for (int a = 0; a < rank; ++a)
                sum += double(T[a][b]) * double(hierarchy.functions()[v][a]);
            return sum;
        });
}

TEST(ClusterHierarchy, RepresentsAffineFieldsOfASurface)
{
    Grids grids;
    grids.add(70, 50);
    for (EmbeddedPoint& p : grids.points)
        p[2] = 0.0;
    expect_affine_fields(grids, Extent::Surface, 128);
}

TEST(ClusterHierarchy, RepresentsAffineFieldsOfAVolume)
{
    Grids grids;
    grids.add(200, 150);
    for (EmbeddedPoint& p : grids.points)
        p[2] = 0.2 * std::sin(10.0 * p[0]) * std::cos(10.0 * p[1]);
    expect_affine_fields(grids, Extent::Volume, 469); // 64 regions; 235 of 128 would be too many
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
