#include "collision/cloth/device_near_pairs.h"

#include <limits>

#include "core/backend/cuda/parallel.cuh"
#include "core/backend/error.h"

namespace toile {

namespace {

/// The order of the trees is chosen anew when their surface has grown by this factor [-], as Candidates'
/// shape.
constexpr double kWornOut = 2.5;

/// Room at first: pairs of a vertex, candidates of a pair.
constexpr int kPairsOfVertex = 2;
constexpr int kCandidatesOfPair = 4;

/// Room is made for this much more than was needed [-].
constexpr double kHeadroom = 1.25;

int with_headroom(long needed)
{
    const long most = std::numeric_limits<int>::max();
    if (needed > most)
        throw DeviceError("near pairs: " + std::to_string(needed) +
                          " candidates are more than a search can hold; is the margin in metres?");
    return int(std::min(long(kHeadroom * double(needed)), most));
}

} // namespace

DeviceNearPairs::DeviceNearPairs(const CudaSpace& space, View<const Triangle> triangles,
                                 View<const Vec3> positions, View<const int> rigid, int room)
    : space_(space), surface_(space, triangles, positions), rigid_(space, "near_pairs/rigid"), all_(space),
      around_(space),
      counts_(space, "near_pairs/counts", positions.size() + surface_.edges().vertex.size() + 1),
      first_(space, "near_pairs/first", counts_.size()),
      kept_for_vertices_(space, "near_pairs/kept_for_vertices",
                         kKeptCandidates * surface_.vertex_order().size()),
      kept_for_edges_(space, "near_pairs/kept_for_edges", kKeptCandidates * surface_.edges().vertex.size()),
      candidates_(space, "near_pairs/candidates"), is_pair_(space, "near_pairs/is_pair"),
      pairs_in_list_(space, "near_pairs/pairs_in_list"), count_(space, "near_pairs/count", 1),
      pairs_(space, "near_pairs/pairs"), numbers_(space, "near_pairs/numbers", 1),
      scratch_(space, "near_pairs/scratch")
{
    rigid_.upload(rigid);
    counts_.fill_zero();
    const long pairs = room > 0 ? room : 1 + long(kPairsOfVertex) * positions.size();
    make_room(kCandidatesOfPair * pairs, pairs);
}

void DeviceNearPairs::make_room(long candidates, long pairs)
{
    if (candidates > candidates_.size()) {
        const int size = with_headroom(candidates);
        candidates_.resize(size);
        is_pair_.resize(size);
        pairs_in_list_.resize(size);
    }
    if (pairs > pairs_.size())
        pairs_.resize(with_headroom(pairs));
    all_.asked = {};
    around_.asked = {};
}

void DeviceNearPairs::begin(View<const Vec3> x, const Ways& ways, double margin)
{
    if (is_worn_out_) {
        surface_.reorder(x);
        ordered_surface_ = 0.0;
        is_worn_out_ = false;
    }
    begun_ = {x, ways, margin};
    search_begun();
}

View<const NearPair> DeviceNearPairs::end()
{
    while (!settle())
        search_begun();
    return pairs().subview(0, numbers_[0].pairs);
}

/// A search that is asked for a second time has grown all that it needs, so it is recorded then.
void DeviceNearPairs::search_begun()
{
    Recording& last = begun_.ways.around.empty() ? all_ : around_;
    const auto search_now = [&] { search(begun_.x, begun_.ways, begun_.margin); };
    if (!last.asked.is(begun_)) {
        search_now();
        last.asked = begun_;
        last.is_recorded = false;
        return;
    }
    if (!last.is_recorded)
        last.graph.record(search_now);
    last.is_recorded = true;
    last.graph.launch();
}

void DeviceNearPairs::search(View<const Vec3> x, const Ways& ways, double margin)
{
    refit(x, ways, margin);
    count_triangles();
    count_edges();
    report(x, ways, margin);
}

bool DeviceNearPairs::settle()
{
    space_.synchronise();
    const SearchNumbers& numbers = numbers_[0];
    if (ordered_surface_ == 0.0)
        ordered_surface_ = numbers.surface;
    is_worn_out_ = numbers.surface > kWornOut * ordered_surface_;

    const bool had_room = numbers.candidates <= candidates_.size() && numbers.pairs <= pairs_.size();
    if (!had_room)
        make_room(numbers.candidates, numbers.pairs);
    return had_room;
}

VertexQueries DeviceNearPairs::vertex_queries() const
{
    return {surface_.used_vertices(), surface_.vertex_order(), surface_.boxes(), corners(), {rigid_.view()}};
}

EdgeQueries DeviceNearPairs::edge_queries() const
{
    const ImplicitBoxTree tree = surface_.edge_tree();
    return {tree.nodes.subview(0, tree.shape.count), corners(), {rigid_.view()}};
}

void DeviceNearPairs::count_triangles()
{
    const VertexQueries queries = vertex_queries();
    parallel_for(space_, "collision/device_count_triangles", queries.size(),
                 CountCandidates<VertexQueries>{queries, surface_.triangle_tree(),
                                                counts_.view().subview(0, surface_.vertex_count()),
                                                kept_for_vertices_.view()},
                 128);
}

void DeviceNearPairs::count_edges()
{
    const EdgeQueries queries = edge_queries();
    parallel_for(space_, "collision/device_count_edges", queries.size(),
                 CountCandidates<EdgeQueries>{queries, surface_.edge_tree(),
                                              counts_.view().subview(surface_.vertex_count(), queries.size()),
                                              kept_for_edges_.view()},
                 128);
}

void DeviceNearPairs::list_candidates()
{
    const int vertices = surface_.vertex_count();
    exclusive_scan(space_, "collision/device_sum", counts_.view(), first_.view(), scratch_);
    const View<const int> counts = counts_.view();
    const View<const long> first = first_.view();
    const VertexQueries by_vertex = vertex_queries();
    parallel_for(space_, "collision/device_list_triangles", by_vertex.size(),
                 ListCandidates<VertexQueries>{by_vertex, surface_.triangle_tree(),
                                               counts.subview(0, vertices), kept_for_vertices_.view(),
                                               first.subview(0, vertices), 0, candidates_.view()},
                 128);
    const EdgeQueries by_edge = edge_queries();
    parallel_for(space_, "collision/device_list_edges", by_edge.size(),
                 ListCandidates<EdgeQueries>{by_edge, surface_.edge_tree(),
                                             counts.subview(vertices, by_edge.size()), kept_for_edges_.view(),
                                             first.subview(vertices, by_edge.size()), vertices,
                                             candidates_.view()},
                 128);
}

void DeviceNearPairs::report(View<const Vec3> x, const Ways& ways, double margin)
{
    list_candidates();
    const CandidateList list{candidates_.view(), surface_.vertex_count()};
    const View<const long> count = first_.view();
    parallel_for(space_, "collision/device_test_candidates", candidates_.size(),
                 TestCandidate{list, count.subview(count.size() - 1, 1), corners(), x, ways, margin,
                               surface_.extent(), is_pair_.view()},
                 128);
    list_flagged(space_, "collision/device_list_pairs", is_pair_.view(), pairs_in_list_.view(), count_.view(),
                 scratch_);
    parallel_for(space_, "collision/device_report_pairs", pairs_.size(),
                 ReportPair{list, pairs_in_list_.view(), count_.view(), surface_.triangles(),
                            surface_.edges(), x, pairs_.view()},
                 128);
    parallel_for(space_, "collision/device_numbers", 1,
                 CollectNumbers{first_.view(), count_.view(), surface_.surface(), numbers_.view()});
}

} // namespace toile
