#include "collision/cloth/device_near_pairs.h"

#include <limits>

#include "core/backend/cuda/teams.cuh"
#include "core/backend/error.h"

namespace toile {

namespace {

/// The order of the trees is chosen anew when their surface has grown by this factor [-], as Candidates'
/// shape.
constexpr double kWornOut = 2.5;

/// Room at first: pairs of a vertex, candidates of a pair.
constexpr int kPairsOfVertex = 2;
constexpr int kCandidatesOfPair = 4;

/// Vertices around which pairs are found sooner without boxes of everything, and room for their candidates at
/// first.
constexpr int kFew = 4000, kRoomOfFew = 1 << 16;

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
    : space_(space), beside_(space, CudaSpace::Beside{}), placed_(space), found_(beside_),
      surface_(space, triangles, positions), rigid_(space, "near_pairs/rigid"),
      graph_(space, "collision/device_search"),
      counts_(space, "near_pairs/counts", positions.size() + surface_.edges().vertex.size() + 1),
      first_(space, "near_pairs/first", counts_.size()),
      kept_for_vertices_(space, "near_pairs/kept_for_vertices",
                         kKeptCandidates * surface_.vertex_order().size()),
      kept_for_edges_(space, "near_pairs/kept_for_edges", kKeptCandidates * surface_.edges().vertex.size()),
      around_(space, "near_pairs/around"), around_counts_(space, "near_pairs/around_counts"),
      around_first_(space, "near_pairs/around_first"), sort_(space), sorted_(space, "near_pairs/sorted"),
      candidates_(space, "near_pairs/candidates"), is_pair_(space, "near_pairs/is_pair"),
      pairs_in_list_(space, "near_pairs/pairs_in_list"), count_(space, "near_pairs/count", 1),
      pairs_(space, "near_pairs/pairs"), numbers_(space, "near_pairs/numbers", 1),
      scratch_(space, "near_pairs/scratch"), around_scratch_(space, "near_pairs/around_scratch")
{
    rigid_.upload(rigid);
    counts_.fill_zero();
    const long pairs = room > 0 ? room : 1 + long(kPairsOfVertex) * positions.size();
    make_room(kCandidatesOfPair * pairs, pairs);
    room_around_ = std::min(candidates_.size(), kRoomOfFew);
}

void DeviceNearPairs::make_room(long candidates, long pairs)
{
    recorded_ = {}; // also where there is no more memory
    if (candidates > candidates_.size()) {
        const int size = with_headroom(candidates);
        candidates_.resize(size);
        is_pair_.resize(size);
        pairs_in_list_.resize(size);
    }
    if (pairs > pairs_.size())
        pairs_.resize(with_headroom(pairs));
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
    const auto search_now = [&] { search(begun_.x, begun_.ways, begun_.margin); };
    if (!recorded_.is(begun_)) {
        search_now();
        recorded_ = begun_;
        is_recorded_ = false;
        return;
    }
    if (!is_recorded_)
        graph_.record(search_now);
    is_recorded_ = true;
    surface_.note(begun_.ways, begun_.margin);
    graph_.launch();
}

View<const NearPair> DeviceNearPairs::find_around(View<const Vec3> x, const Ways& ways, int count,
                                                  double margin)
{
    TOILE_ASSERT(margin <= surface_.boxes().margin);
    if (count > kFew) {
        do
            search(x, ways, margin);
        while (!settle());
    } else if (count > 0) {
        search_around_few(x, ways, count, margin);
    } else {
        return {};
    }
    return pairs().subview(0, numbers_[0].pairs);
}

void DeviceNearPairs::search_around_few(View<const Vec3> x, const Ways& ways, int count, double margin)
{
    around_.resize(x.size());
    list_flagged(space_, "collision/device_list_around", ways.around, around_.view(), count_.view(),
                 around_scratch_);
    const View<const int> vertices = around_.view().subview(0, count);
    surface_.move_some(vertices, x, ways);
    const CandidatesAround around{surface_.changed(vertices, ways.around), surface_.triangle_tree(),
                                  surface_.edge_tree(), vertex_queries(), edge_queries()};
    const int teams = around.team_count();
    const int blocks = block_count(teams + 1, TeamsAround::kTeams);
    around_counts_.resize(teams + 1);
    around_first_.resize(teams + 1);
    parallel_for_blocks<TeamsAround::kThreads>(space_, "collision/device_count_around", blocks,
                                               TeamsAround::kBytes,
                                               CountCandidatesAround{around, around_counts_.view()});
    exclusive_scan(space_, "collision/device_sum_around", around_counts_.view(), around_first_.view(),
                   around_scratch_);
    do {
        const View<Record> room = candidates_.view().subview(0, room_around_);
        parallel_for_blocks<TeamsAround::kThreads>(space_, "collision/device_candidates_around", blocks,
                                                   TeamsAround::kBytes,
                                                   ListCandidatesAround{around, around_first_.view(), room});
        list_pairs(room, around_first_.view(), {}, x, ways, margin, around_scratch_);
    } while (!settle_around());
    report_sorted(numbers_[0].pairs, x);
}

/// In the order of their numbers.
void DeviceNearPairs::report_sorted(int count, View<const Vec3> x)
{
    const CandidateList list{candidates_.view(), surface_.vertex_count()};
    const long seconds = std::max(triangles().size(), edges().vertex.size());
    sort_.resize(count);
    sorted_.resize(count);
    parallel_for(space_, "collision/device_key_around", count,
                 KeyPair{list, pairs_in_list_.view(), seconds, sort_.keys.view(), sort_.values.view()});
    sort_by_key(space_, "collision/device_sort_around", sort_, sorted_.view(),
                key_bits((surface_.vertex_count() + edges().vertex.size()) * seconds));
    parallel_for(space_, "collision/device_report_around", count,
                 ReportSortedPair{list, sorted_.view(), triangles(), edges(), x, pairs_.view()});
}

void DeviceNearPairs::search(View<const Vec3> x, const Ways& ways, double margin)
{
    surface_.place(x, ways, margin);
    placed_.record();

    placed_.delay(beside_);
    surface_.refit_edges(beside_);
    count_edges_on(beside_);
    found_.record();

    surface_.refit_triangles();
    count_triangles();
    found_.delay(space_);
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

/// The same of a search around few vertices.
bool DeviceNearPairs::settle_around()
{
    space_.synchronise();
    const SearchNumbers& numbers = numbers_[0];
    const bool had_room = numbers.candidates <= room_around_ && numbers.pairs <= pairs_.size();
    if (!had_room) {
        room_around_ = std::max(room_around_, with_headroom(numbers.candidates));
        make_room(room_around_, numbers.pairs);
    }
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

void DeviceNearPairs::count_edges_on(const CudaSpace& on)
{
    const EdgeQueries queries = edge_queries();
    parallel_for(on, "collision/device_count_edges", queries.size(),
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
    list_pairs(candidates_.view(), first_.view(), surface_.extent(), x, ways, margin, scratch_);
    parallel_for(space_, "collision/device_report_pairs", pairs_.size(),
                 ReportPair{{candidates_.view(), surface_.vertex_count()},
                            pairs_in_list_.view(),
                            count_.view(),
                            triangles(),
                            edges(),
                            x,
                            pairs_.view()});
}

/// Pairs among candidates, and the numbers of both.
/// @param first   sums of candidates; the last is the number of all
/// @param extent  as TestCandidate has it
void DeviceNearPairs::list_pairs(View<const Record> candidates, View<const long> first,
                                 View<const SoupExtent> extent, View<const Vec3> x, const Ways& ways,
                                 double margin, DeviceScratch& scratch)
{
    const View<unsigned char> flags = is_pair_.view().subview(0, candidates.size());
    parallel_for(space_, "collision/device_test_candidates", candidates.size(),
                 TestCandidate{{candidates, surface_.vertex_count()},
                               first.subview(first.size() - 1, 1),
                               corners(),
                               x,
                               ways,
                               margin,
                               extent,
                               flags},
                 128);
    list_flagged(space_, "collision/device_list_pairs", flags, pairs_in_list_.view(), count_.view(), scratch);
    parallel_for(space_, "collision/device_numbers", 1,
                 CollectNumbers{first, count_.view(), surface_.surface(), numbers_.view()});
}

} // namespace toile
