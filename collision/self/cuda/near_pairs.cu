#include "collision/self/cuda/near_pairs.h"

#include <algorithm>
#include <limits>

#include "core/base/error.h"
#include "core/compute/cuda/teams.cuh"

namespace toile::collision {

namespace {

/// Growth of the trees' surface [-] after which their order is chosen anew, as in Candidates.
constexpr double kWornOut = 2.5;

/// Initial capacity: pairs per vertex, candidates per pair.
constexpr int kPairsOfVertex = 2;
constexpr int kCandidatesOfPair = 4;

/// Maximum number of vertices for which a local search is faster than one of the whole soup, and its initial
/// capacity for candidates.
constexpr int kFew = 4000, kCapacityOfFew = 1 << 16;

/// Capacity relative to the needed size [-].
constexpr double kHeadroom = 1.25;

int with_headroom(long needed)
{
    return int(std::min(long(kHeadroom * double(needed)), long(std::numeric_limits<int>::max())));
}

/// Candidates that a search lists at most: of a vertex, and in small soups. Cloth at rest has 10 to 100 a
/// vertex; each takes 13 bytes.
constexpr long kMaxCandidatesOfVertex = 512, kMaxCandidatesOfFew = 1L << 22;

/// Marks of prescribed vertices, among which there are no pairs; empty without any.
std::vector<unsigned char> prescribed(View<const int> rigid)
{
    std::vector<unsigned char> marks;
    if (std::find(rigid.begin(), rigid.end(), kPrescribed) != rigid.end())
        for (const int number : rigid)
            marks.push_back((unsigned char)(number == kPrescribed ? 1 : 0));
    return marks;
}

} // namespace

DeviceNearPairs::DeviceNearPairs(const CudaSpace& space, View<const Triangle> triangles,
                                 View<const Vec3> positions, View<const int> rigid, int capacity)
    : space_(space), beside_(space, CudaSpace::Beside{}), placed_(space), found_(beside_),
      surface_(space, triangles, positions, prescribed(rigid)), rigid_(space, "near_pairs/rigid"),
      graph_(space, "collision/device_search"),
      counts_(space, "near_pairs/counts", positions.size() + surface_.edges().vertex.size() + 1),
      first_(space, "near_pairs/first", counts_.size()),
      kept_for_vertices_(space, "near_pairs/kept_for_vertices",
                         kKeptCandidates * surface_.vertex_order().size()),
      kept_for_edges_(space, "near_pairs/kept_for_edges", kKeptCandidates * surface_.edges().vertex.size()),
      near_vertices_(space, "near_pairs/near"), near_counts_(space, "near_pairs/around_counts"),
      near_first_(space, "near_pairs/near_first"), sort_(space), sorted_(space, "near_pairs/sorted"),
      candidates_(space, "near_pairs/candidates"), is_pair_(space, "near_pairs/is_pair"),
      pairs_in_list_(space, "near_pairs/pairs_in_list"), count_(space, "near_pairs/count", 1),
      pairs_(space, "near_pairs/pairs"), numbers_(space, "near_pairs/numbers", 1),
      scratch_(space, "near_pairs/scratch"), near_scratch_(space, "near_pairs/near_scratch")
{
    rigid_.upload(rigid);
    counts_.fill_zero();
    const long pairs = capacity > 0 ? capacity : 1 + long(kPairsOfVertex) * positions.size();
    reserve(kCandidatesOfPair * pairs, pairs);
    near_capacity_ = std::min(candidates_.size(), kCapacityOfFew);
}

void DeviceNearPairs::reserve(long candidates, long pairs)
{
    recorded_ = {}; // also if an allocation below fails
    if (candidates > candidates_.size()) {
        const int size = with_headroom(candidates);
        candidates_.resize(size);
        is_pair_.resize(size);
        pairs_in_list_.resize(size);
    }
    if (pairs > pairs_.size())
        pairs_.resize(with_headroom(pairs));
}

void DeviceNearPairs::require_few(long candidates) const
{
    const long all = std::numeric_limits<int>::max();
    const long few = std::max(kMaxCandidatesOfFew, kMaxCandidatesOfVertex * surface_.vertex_count());
    if (candidates > (is_limited_ ? std::min(few, all) : all))
        throw TooManyPairs("near pairs: " + std::to_string(candidates) + " candidates of " +
                           std::to_string(surface_.vertex_count()) +
                           " vertices are more than a search lists; is the margin in metres?");
}

void DeviceNearPairs::begin(View<const Vec3> x, const Trajectories& trajectories, double margin)
{
    if (is_worn_out_) {
        surface_.reorder(x);
        ordered_surface_ = 0.0;
        is_worn_out_ = false;
    }
    begun_ = {x, trajectories, margin};
    search_begun();
}

View<const NearPair> DeviceNearPairs::end()
{
    while (!complete())
        search_begun();
    return pairs().subview(0, numbers_[0].pairs);
}

/// Runs the begun search. A repeated search has all the capacity that it needs, so it is recorded then.
void DeviceNearPairs::search_begun()
{
    const auto search_now = [&] { search(begun_.x, begun_.trajectories, begun_.margin); };
    if (!recorded_.is(begun_)) {
        search_now();
        recorded_ = begun_;
        is_recorded_ = false;
        return;
    }
    if (!is_recorded_)
        graph_.record(search_now);
    is_recorded_ = true;
    surface_.note(begun_.trajectories, begun_.margin);
    graph_.launch();
}

View<const NearPair> DeviceNearPairs::find_near(View<const Vec3> x, const Trajectories& trajectories,
                                                int count, double margin)
{
    TOILE_ASSERT(margin <= surface_.boxes().margin);
    if (count > kFew) {
        do
            search(x, trajectories, margin);
        while (!complete());
    } else if (count > 0) {
        search_near_few(x, trajectories, count, margin);
    } else {
        return {};
    }
    return pairs().subview(0, numbers_[0].pairs);
}

void DeviceNearPairs::search_near_few(View<const Vec3> x, const Trajectories& trajectories, int count,
                                      double margin)
{
    near_vertices_.resize(x.size());
    list_flagged(space_, "collision/device_list_near", trajectories.selected, near_vertices_.view(),
                 count_.view(), near_scratch_);
    const View<const int> vertices = near_vertices_.view().subview(0, count);
    surface_.move_some(vertices, x, trajectories);
    const NearbyCandidates nearby{surface_.changed(vertices, trajectories.selected), surface_.triangle_tree(),
                                  surface_.edge_tree(), vertex_queries(), edge_queries()};
    const int teams = nearby.team_count();
    const int blocks = block_count(teams + 1, NearbyTeams::kTeams);
    near_counts_.resize(teams + 1);
    near_first_.resize(teams + 1);
    parallel_for_blocks<NearbyTeams::kThreads>(space_, "collision/device_count_near", blocks,
                                               NearbyTeams::kBytes,
                                               CountNearbyCandidates{nearby, near_counts_.view()});
    exclusive_scan(space_, "collision/device_sum_near", near_counts_.view(), near_first_.view(),
                   near_scratch_);
    do {
        const View<Record> listed = candidates_.view().subview(0, near_capacity_);
        parallel_for_blocks<NearbyTeams::kThreads>(space_, "collision/device_candidates_near", blocks,
                                                   NearbyTeams::kBytes,
                                                   ListNearbyCandidates{nearby, near_first_.view(), listed});
        list_pairs(listed, near_first_.view(), {}, x, trajectories, margin, near_scratch_);
    } while (!complete_near());
    report_sorted(numbers_[0].pairs, x);
}

/// Writes the pairs in the order of their numbers.
void DeviceNearPairs::report_sorted(int count, View<const Vec3> x)
{
    const CandidateList list{candidates_.view(), surface_.vertex_count()};
    const long seconds = std::max(triangles().size(), edges().vertex.size());
    sort_.resize(count);
    sorted_.resize(count);
    parallel_for(space_, "collision/device_key_near", count,
                 KeyPair{list, pairs_in_list_.view(), seconds, sort_.keys.view(), sort_.values.view()});
    sort_by_key(space_, "collision/device_sort_near", sort_, sorted_.view(),
                key_bits((surface_.vertex_count() + edges().vertex.size()) * seconds));
    parallel_for(space_, "collision/device_report_near", count,
                 ReportSortedPair{list, sorted_.view(), triangles(), edges(), x, pairs_.view()});
}

void DeviceNearPairs::search(View<const Vec3> x, const Trajectories& trajectories, double margin)
{
    surface_.place(x, trajectories, margin);
    placed_.record();

    placed_.delay(beside_);
    surface_.refit_edges(beside_);
    count_edges_on(beside_);
    found_.record();

    surface_.refit_triangles();
    count_triangles();
    found_.delay(space_);
    report(x, trajectories, margin);
}

bool DeviceNearPairs::complete()
{
    space_.synchronise();
    const SearchNumbers& numbers = numbers_[0];
    require_few(numbers.candidates);
    if (ordered_surface_ == 0.0)
        ordered_surface_ = numbers.surface;
    is_worn_out_ = numbers.surface > kWornOut * ordered_surface_;

    const bool had_capacity = numbers.candidates <= candidates_.size() && numbers.pairs <= pairs_.size();
    if (!had_capacity)
        reserve(numbers.candidates, numbers.pairs);
    return had_capacity;
}

/// Does as complete() for a search near few vertices.
bool DeviceNearPairs::complete_near()
{
    space_.synchronise();
    const SearchNumbers& numbers = numbers_[0];
    require_few(numbers.candidates);
    const bool had_capacity = numbers.candidates <= near_capacity_ && numbers.pairs <= pairs_.size();
    if (!had_capacity) {
        near_capacity_ = std::max(near_capacity_, with_headroom(numbers.candidates));
        reserve(near_capacity_, numbers.pairs);
    }
    return had_capacity;
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

void DeviceNearPairs::report(View<const Vec3> x, const Trajectories& trajectories, double margin)
{
    list_candidates();
    list_pairs(candidates_.view(), first_.view(), surface_.extent(), x, trajectories, margin, scratch_);
    parallel_for(space_, "collision/device_report_pairs", pairs_.size(),
                 ReportPair{{candidates_.view(), surface_.vertex_count()},
                            pairs_in_list_.view(),
                            count_.view(),
                            triangles(),
                            edges(),
                            x,
                            pairs_.view()});
}

/// Lists the pairs among candidates, and the numbers of both.
/// @param first   offsets of candidates; the last is their total number
/// @param extent  see TestCandidate
void DeviceNearPairs::list_pairs(View<const Record> candidates, View<const long> first,
                                 View<const SoupExtent> extent, View<const Vec3> x,
                                 const Trajectories& trajectories, double margin, DeviceScratch& scratch)
{
    const View<unsigned char> flags = is_pair_.view().subview(0, candidates.size());
    parallel_for(space_, "collision/device_test_candidates", candidates.size(),
                 TestCandidate{{candidates, surface_.vertex_count()},
                               first.subview(first.size() - 1, 1),
                               corners(),
                               x,
                               trajectories,
                               margin,
                               extent,
                               flags},
                 128);
    list_flagged(space_, "collision/device_list_pairs", flags, pairs_in_list_.view(), count_.view(), scratch);
    parallel_for(space_, "collision/device_numbers", 1,
                 CollectNumbers{first, count_.view(), surface_.surface(), numbers_.view()});
}

} // namespace toile::collision
