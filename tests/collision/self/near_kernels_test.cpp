#include "collision/self/cuda/nearby_kernels.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>

#include <gtest/gtest.h>

#include "collision/self/near_pairs.h"
#include "tests/collision/geometry/surface_on_cpu.h"
#include "tests/collision/self/pairs_near_vertices.h"
#include "tests/collision/self/same_pairs.h"
#include "tests/collision/soups.h"

namespace toile::test {

using namespace collision;

namespace {

using test::folded_sheet;
using test::Random;
using test::random_soup;
using test::Soup;

/// Search of DeviceNearPairs: its kernels, run on the CPU.
class SearchOnCpu {
public:
    SearchOnCpu(const Soup& soup, double margin)
        : soup_(soup), surface_(soup.triangles, soup.x, soup.trajectories(), margin)
    {
        find(margin);
    }

    const std::vector<NearPair>& pairs() const { return pairs_; }

private:
    template <typename Queries>
    void list(const Queries& queries, const ImplicitBoxTree& tree, int first_number, int count)
    {
        std::vector<int> kept(kKeptCandidates * queries.size());
        const View<int> counts = View<int>(counts_).subview(first_number, count);
        parallel_for(kCpu, "test/count", queries.size(),
                     CountCandidates<Queries>{queries, tree, counts, kept});
        std::exclusive_scan(counts_.begin(), counts_.end(), first_.begin(), 0L);
        candidates_.resize(first_.back());
        parallel_for(kCpu, "test/list", queries.size(),
                     ListCandidates<Queries>{queries, tree, counts, kept,
                                             View<const long>(first_).subview(first_number, count),
                                             first_number, candidates_});
    }

    void find(double margin)
    {
        const SurfaceEdges& edges = surface_.edges;
        const int vertices = surface_.vertex_count();
        const PairCorners corners{soup_.triangles, edges.vertex};
        counts_.assign(vertices + edges.edge_count() + 1, 0);
        first_.resize(counts_.size());
        list(VertexQueries{surface_.used, surface_.vertex_order, surface_.boxes, corners, {}},
             surface_.triangle_tree(), 0, vertices);
        list(EdgeQueries{surface_.edge_items(), corners, {}}, surface_.edge_tree(), vertices,
             edges.edge_count());

        const CandidateList list{candidates_, vertices};
        const std::vector<long> candidate_count{first_.back()};
        std::vector<unsigned char> is_pair(candidates_.size());
        parallel_for(kCpu, "test/test", int(candidates_.size()),
                     TestCandidate{list, candidate_count, corners, soup_.x, soup_.trajectories(), margin,
                                   surface_.extent, is_pair});
        std::vector<int> pairs_in_list;
        for (int i = 0; i < int(is_pair.size()); ++i)
            if (is_pair[i] != 0)
                pairs_in_list.push_back(i);
        const std::vector<int> count{int(pairs_in_list.size())};
        pairs_.resize(pairs_in_list.size());
        parallel_for(
            kCpu, "test/report", count[0],
            ReportPair{list, pairs_in_list, count, soup_.triangles, view_of(edges), soup_.x, pairs_});
    }

    const Soup& soup_;
    test::SurfaceOnCpu surface_;
    std::vector<int> counts_;
    std::vector<long> first_;
    std::vector<Record> candidates_;
    std::vector<NearPair> pairs_;
};

void expect_those_of_near_pairs(const Soup& soup, double margin, size_t min_count)
{
    std::vector<NearPair> expected;
    NearPairs(soup.triangles, soup.x).find(soup.x, soup.trajectories(), margin, expected);
    test::expect_same(expected, SearchOnCpu(soup, margin).pairs(), "on the CPU");
    EXPECT_GE(expected.size(), min_count);
}

TEST(DeviceNearKernels, MatchNearPairsInRandomSoups)
{
    Random random(41);
    for (int i = 0; i < 10; ++i)
        expect_those_of_near_pairs(random_soup(random), 0.05, 100);
}

TEST(DeviceNearKernels, MatchNearPairsOnFoldedSheets)
{
    Random random(42);
    const Soup soup = folded_sheet(random);
    expect_those_of_near_pairs(soup, 0.0, 100);
    expect_those_of_near_pairs(soup, 0.003, 1000); // more candidates than the capacity of a query
}

TEST(DeviceNearKernels, AcceptEmptyInput)
{
    Soup soup;
    expect_those_of_near_pairs(soup, 1.0, 0);
    soup.x = {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()};
    soup.stand_still();
    expect_those_of_near_pairs(soup, 1.0, 0);
    soup.triangles = {{0, 1, 2}};
    expect_those_of_near_pairs(soup, 1.0, 0);
}

/// Search of DeviceNearPairs near vertices of a soup with changed trajectories, repeated after a full search.
class SearchNearOnCpu {
public:
    SearchNearOnCpu(Soup& soup, double margin, std::vector<int> rigid = {})
        : soup_(soup), margin_(margin), rigid_(std::move(rigid)),
          surface_(soup.triangles, soup.x, soup.trajectories(), margin)
    {
    }

    /// @param selected  vertices with changed trajectories
    std::vector<NearPair> compare(const std::vector<unsigned char>& selected)
    {
        std::vector<NearPair> found = find({soup_.motion, soup_.slack, selected});
        test::expect_pairs_near(found, soup_, selected, margin_, rigid_);
        return found;
    }

private:
    std::vector<NearPair> find(const Trajectories& trajectories)
    {
        std::vector<int> changed;
        for (int v = 0; v < trajectories.selected.size(); ++v)
            if (trajectories.selected[v] != 0)
                changed.push_back(v);
        surface_.move_some(changed, trajectories);

        const PairCorners corners{soup_.triangles, surface_.edges.vertex};
        const NearbyCandidates nearby{
            surface_.changed(changed, trajectories.selected),
            surface_.triangle_tree(),
            surface_.edge_tree(),
            {surface_.used, surface_.vertex_order, surface_.boxes, corners, {rigid_}},
            {surface_.edge_items(), corners, {rigid_}}};
        std::vector<int> stack(TeamDescent::kStack);
        std::vector<Record> candidates;
        for (int i = 0; i < nearby.team_count(); ++i) {
            const int first = int(candidates.size());
            const int count = nearby.visit(i, {Team{0}, stack}, [&](int slot, const Record& candidate) {
                EXPECT_EQ(first + slot, int(candidates.size()));
                candidates.push_back(candidate);
            });
            EXPECT_EQ(first + count, int(candidates.size()));
        }
        return report({candidates, surface_.vertex_count()}, corners, trajectories);
    }

    std::vector<NearPair> report(const CandidateList& list, const PairCorners& corners,
                                 const Trajectories& trajectories)
    {
        const int candidates = list.candidates.size();
        const std::vector<long> candidate_count{candidates};
        std::vector<unsigned char> is_pair(candidates);
        parallel_for(
            kCpu, "test/test", candidates,
            TestCandidate{list, candidate_count, corners, soup_.x, trajectories, margin_, {}, is_pair});
        std::vector<int> in_list;
        for (int i = 0; i < candidates; ++i)
            if (is_pair[i] != 0)
                in_list.push_back(i);

        const int count = int(in_list.size());
        const long seconds = std::max(soup_.triangles.size(), surface_.edges.vertex.size());
        std::vector<std::uint64_t> keys(count);
        std::vector<int> values(count), order(count), sorted(count);
        parallel_for(kCpu, "test/key", count, KeyPair{list, in_list, seconds, keys, values});
        std::iota(order.begin(), order.end(), 0);
        std::sort(order.begin(), order.end(), [&](int a, int b) { return keys[a] < keys[b]; });
        for (int i = 0; i < count; ++i)
            sorted[i] = values[order[i]];
        std::vector<NearPair> pairs(count);
        parallel_for(
            kCpu, "test/report", count,
            ReportSortedPair{list, sorted, soup_.triangles, view_of(surface_.edges), soup_.x, pairs});
        return pairs;
    }

    Soup& soup_;
    double margin_;
    std::vector<int> rigid_;
    test::SurfaceOnCpu surface_;
};

TEST(DeviceNearKernels, FindThePairsNearVerticesWithChangedTrajectories)
{
    Random random(44);
    size_t count = 0;
    for (int i = 0; i < 12; ++i) {
        Soup soup = i % 2 == 0 ? random_soup(random) : folded_sheet(random);
        if (i % 4 == 3)
            soup.stand_still(); // static, then some vertices move
        SearchNearOnCpu search(soup, 0.003);
        for (const int vertices : {1, 30, 200})
            count += search.compare(test::send_elsewhere(random, soup, vertices)).size();
    }
    EXPECT_GT(count, 10000u);
}

TEST(DeviceNearKernels, FindNoPairsWithinOneRigidBodyNearItsVertices)
{
    Random random(46);
    Soup soup = folded_sheet(random);
    std::vector<int> rigid(soup.x.size());
    for (size_t v = 0; v < rigid.size(); ++v)
        rigid[v] = int(v / 24) % 3 - 1; // rows of the sheet; -1 is no body
    SearchNearOnCpu search(soup, 0.003, rigid);
    EXPECT_GT(search.compare(test::send_elsewhere(random, soup, 100)).size(), 1000u);
}

TEST(DeviceNearKernels, FindPairsOfAVertexThatLeavesAllPreviousBounds)
{
    Random random(45);
    Soup soup = folded_sheet(random);
    soup.stand_still();
    const int far_away = int(soup.x.size()), traveller = 100;
    add_sheet(soup, 3, 0.01, 40.0);
    SearchNearOnCpu search(soup, 0.003);
    std::vector<unsigned char> selected(soup.x.size());
    selected[traveller] = 1;
    soup.motion[traveller] = 2.0 * (Vec3(0.013, 40.0, 0.012) - soup.x[traveller]); // through it half-way
    const std::vector<NearPair> found = search.compare(selected);
    EXPECT_TRUE(std::any_of(found.begin(), found.end(), [&](const NearPair& pair) {
        return !pair.is_edge_edge && pair.first == traveller && pair.vertex[1] >= far_away;
    }));
}

TEST(ImplicitBoxTree, VisitsOverlappingItemsInOrder)
{
    Random random(43);
    for (const int count : {0, 1, 2, 4, 5, 16, 17, 64, 65, 1000}) {
        const ImplicitShape shape(count);
        std::vector<BoxNode> nodes(shape.node_count());
        const auto box = [&](double size) {
            Box made;
            for (int k = 0; k < 3; ++k) {
                made.lower[k] = float(random.uniform(0, 1));
                made.upper[k] = made.lower[k] + float(random.uniform(0, size));
            }
            return made;
        };
        for (int i = 0; i < count; ++i)
            nodes[i] = BoxNode::of_item(box(0.3), (7 * i) % count, random.below(2) == 0);
        for (int level = 1; level <= shape.top; ++level)
            for (int c = 0; c < shape.size_of(level); ++c)
                for (int k = 0; k < ImplicitShape::kFan; ++k)
                    nodes[shape.first[level] + c].add(
                        nodes[shape.first[level - 1] + ImplicitShape::kFan * c + k]);
        const ImplicitBoxTree tree{shape, nodes};
        for (int query = 0; query < 100; ++query) {
            const BoxNode asking = BoxNode::of_item(box(0.3), 0, random.below(2) == 0);
            const int above = random.below(count + 1) - 1;
            std::vector<int> expected, found;
            for (int i = 0; i < count; ++i)
                if (nodes[i].box().overlaps(asking.box()) && nodes[i].last > above &&
                    (nodes[i].is_wanted != 0 || asking.is_wanted != 0))
                    expected.push_back(nodes[i].last);
            tree.visit_overlapping(asking, above, [&](int item) { found.push_back(item); });
            ASSERT_EQ(found, expected) << count;
        }
    }
}

TEST(SpaceCurve, VisitsNeighbouringCellsInSequence)
{
    // Cells of a coarser grid, sorted by the curve index of their centres, follow each other as neighbours.
    const SpaceCurve curve = SpaceCurve::through(Vec3::Zero(), Vec3::Ones());
    constexpr int kSide = 16;
    std::vector<std::pair<std::uint64_t, std::array<int, 3>>> cells;
    for (int i = 0; i < kSide; ++i)
        for (int j = 0; j < kSide; ++j)
            for (int k = 0; k < kSide; ++k)
                cells.push_back({curve.index(Vec3(i + 0.5, j + 0.5, k + 0.5) / kSide), {i, j, k}});
    std::sort(cells.begin(), cells.end());
    for (size_t c = 1; c < cells.size(); ++c) {
        const std::array<int, 3>&a = cells[c - 1].second, &b = cells[c].second;
        EXPECT_EQ(std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]), 1);
    }
}

} // namespace
} // namespace toile::test
