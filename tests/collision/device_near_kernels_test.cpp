#include "collision/cloth/device_near_kernels.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>

#include <gtest/gtest.h>

#include "collision/cloth/near_pairs.h"
#include "core/backend/parallel.h"
#include "tests/collision/same_pairs.h"
#include "tests/collision/soups.h"

namespace toile {
namespace {

using test::folded_sheet;
using test::Random;
using test::random_soup;
using test::Soup;

/// The search of DeviceNearPairs, with the same bodies, on the CPU.
class SearchOnCpu {
public:
    SearchOnCpu(const Soup& soup, double margin)
        : soup_(soup), edges_(build_surface_edges(soup.triangles, int(soup.x.size())))
    {
        extent_[0] = parallel_sum(kCpu, vertex_count(), SoupExtent(), ExtentOfVertex{soup.x, soup.motion});
        points_.resize(soup.x.size());
        largest_[0] =
            parallel_sum(kCpu, vertex_count(), Largest(), PlacePoint{soup.x, soup.ways(), extent_, points_});
        boxes_ = {points_, {}, largest_, margin};
        for (int v = 0; v < vertex_count(); ++v)
            if (!edges_.corners_of_vertex.of(v).empty())
                used_.push_back({v});
        build<Triangle>(soup.triangles, triangle_shape_, triangle_nodes_);
        build<std::array<int, 2>>(edges_.vertex, edge_shape_, edge_nodes_);
        vertex_order_ = order_of<std::array<int, 1>>(used_);
        find(margin);
    }

    const std::vector<NearPair>& pairs() const { return pairs_; }

private:
    int vertex_count() const { return int(soup_.x.size()); }

    template <typename Primitive>
    std::vector<int> order_of(View<const Primitive> primitives)
    {
        std::vector<std::uint64_t> keys(primitives.size());
        std::vector<int> order(primitives.size());
        parallel_for(kCpu, "test/curve", primitives.size(),
                     PlaceOnCurve<Primitive>{primitives, soup_.x, extent_, keys, order});
        std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return keys[a] < keys[b]; });
        return order;
    }

    template <typename Primitive>
    void build(View<const Primitive> primitives, ImplicitShape& shape, std::vector<BoxNode>& nodes)
    {
        shape = ImplicitShape(primitives.size());
        nodes.assign(shape.node_count(), BoxNode());
        const std::vector<int> order = order_of<Primitive>(primitives);
        parallel_for(kCpu, "test/refit", shape.size_of(1),
                     RefitItems<Primitive>{shape, order, primitives, boxes_, nodes});
        for (int level = 2; level <= shape.top; ++level)
            for (int c = 0; c < shape.size_of(level); ++c)
                RefitNodes{shape, nodes}(level - 1, c);
    }

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
        const PairCorners corners{soup_.triangles, edges_.vertex};
        counts_.assign(vertex_count() + edges_.edge_count() + 1, 0);
        first_.resize(counts_.size());
        list(VertexQueries{used_, vertex_order_, boxes_, corners, {}}, {triangle_shape_, triangle_nodes_}, 0,
             vertex_count());
        list(EdgeQueries{View<const BoxNode>(edge_nodes_).subview(0, edge_shape_.count), corners, {}},
             {edge_shape_, edge_nodes_}, vertex_count(), edges_.edge_count());

        const CandidateList list{candidates_, vertex_count()};
        const std::vector<long> candidate_count{first_.back()};
        std::vector<unsigned char> is_pair(candidates_.size());
        parallel_for(
            kCpu, "test/test", int(candidates_.size()),
            TestCandidate{list, candidate_count, corners, soup_.x, soup_.ways(), margin, extent_, is_pair});
        std::vector<int> pairs_in_list;
        for (int i = 0; i < int(is_pair.size()); ++i)
            if (is_pair[i] != 0)
                pairs_in_list.push_back(i);
        const std::vector<int> count{int(pairs_in_list.size())};
        pairs_.resize(pairs_in_list.size());
        parallel_for(
            kCpu, "test/report", count[0],
            ReportPair{list, pairs_in_list, count, soup_.triangles, view_of(edges_), soup_.x, pairs_});
    }

    const Soup& soup_;
    SurfaceEdges edges_;
    std::vector<std::array<int, 1>> used_;
    std::vector<int> vertex_order_;
    std::vector<SoupExtent> extent_{1};
    std::vector<Largest> largest_{1};
    std::vector<MovingPoint> points_;
    BoxesAtPoints boxes_;
    ImplicitShape triangle_shape_{0}, edge_shape_{0};
    std::vector<BoxNode> triangle_nodes_, edge_nodes_;
    std::vector<int> counts_;
    std::vector<long> first_;
    std::vector<Record> candidates_;
    std::vector<NearPair> pairs_;
};

void expect_those_of_near_pairs(const Soup& soup, double margin, size_t least)
{
    std::vector<NearPair> expected;
    NearPairs(soup.triangles, soup.x).find(soup.x, soup.ways(), margin, expected);
    test::expect_same(expected, SearchOnCpu(soup, margin).pairs(), "on the CPU");
    EXPECT_GE(expected.size(), least);
}

TEST(DeviceNearKernels, FindThePairsOfNearPairsInRandomSoups)
{
    Random random(41);
    for (int i = 0; i < 10; ++i)
        expect_those_of_near_pairs(random_soup(random), 0.05, 100);
}

TEST(DeviceNearKernels, FindThePairsOfNearPairsOnFoldedSheets)
{
    Random random(42);
    const Soup soup = folded_sheet(random);
    expect_those_of_near_pairs(soup, 0.0, 100);
    expect_those_of_near_pairs(soup, 0.003, 1000); // more candidates than a query keeps
}

TEST(DeviceNearKernels, FindNothingInNothing)
{
    Soup soup;
    expect_those_of_near_pairs(soup, 1.0, 0);
    soup.x = {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()};
    soup.stand_still();
    expect_those_of_near_pairs(soup, 1.0, 0);
    soup.triangles = {{0, 1, 2}};
    expect_those_of_near_pairs(soup, 1.0, 0);
}

TEST(ImplicitBoxTree, VisitsWhatOverlapsInOrder)
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

TEST(SpaceCurve, GoesFromCellToNeighbouringCell)
{
    // Sorted by the places of their middles, cells of a coarser grid follow each other like neighbours.
    const SpaceCurve curve = SpaceCurve::through(Vec3::Zero(), Vec3::Ones());
    constexpr int kSide = 16;
    std::vector<std::pair<std::uint64_t, std::array<int, 3>>> cells;
    for (int i = 0; i < kSide; ++i)
        for (int j = 0; j < kSide; ++j)
            for (int k = 0; k < kSide; ++k)
                cells.push_back({curve.place(Vec3(i + 0.5, j + 0.5, k + 0.5) / kSide), {i, j, k}});
    std::sort(cells.begin(), cells.end());
    for (size_t c = 1; c < cells.size(); ++c) {
        const std::array<int, 3>&a = cells[c - 1].second, &b = cells[c].second;
        EXPECT_EQ(std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]), 1);
    }
}

} // namespace
} // namespace toile
