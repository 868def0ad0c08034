#include "collision/self/near_pairs.h"

#include <algorithm>
#include <utility>

#include "collision/self/candidates.h"
#include "collision/self/kept_pairs.h"
#include "collision/self/ordered_records.h"
#include "collision/self/pair_rules.h"
#include "core/compute/parallel.h"

namespace toile::collision {

namespace {

/// Kept pairs per task.
constexpr int kPairsOfTask = 4096;

/// Mean length of the edges that are not prescribed [m]; 0 without any.
double mean_length(const SurfaceEdges& edges, View<const Vec3> x, const std::vector<int>& rigid)
{
    double sum = 0.0;
    int count = 0;
    for (const auto& [a, b] : edges.vertex)
        if (rigid.empty() || rigid[a] != kPrescribed) {
            sum += (x[b] - x[a]).norm();
            ++count;
        }
    return count > 0 ? sum / count : 0.0;
}

} // namespace

class NearPairs::Search {
public:
    Search(View<const Triangle> triangle_list, View<const Vec3> positions, std::vector<int> rigid,
           Keeping keeping);

    void find(View<const Vec3> x, const Trajectories& trajectories, double margin,
              std::vector<NearPair>& out);
    const SurfaceEdges& edges() const { return edges_; }
    SoupView soup() const { return {triangles_, view_of(edges_)}; }

private:
    /// Records that one task found: (vertex, triangle) and (edge, edge).
    struct Found {
        std::vector<Record> vertex_triangle, edge_edge;
    };

    void keep();
    void search(View<const unsigned char> selected, Candidates::Prescribed prescribed);
    void query_kept();
    void query_kept(View<const KeptPairs::Pair> kept, bool is_edge_edge);
    View<Found> begin_tasks(int count);
    void order();
    void report(std::vector<NearPair>& out);
    void take(const OrderedRecords& records, bool is_edge_edge, std::vector<KeptPairs::Pair>& kept) const;
    void try_edges(int e, int f, Found& found) const;
    void try_triangle(int v, int t, Found& found) const;

    PairCorners corners() const { return {triangles_, edges_.vertex}; }
    bool is_wanted(const std::array<int, 4>& v) const
    {
        return (trajectories_.selected.empty() || is_any_marked(v, trajectories_.selected)) &&
               (out_of_bounds_.empty() || is_any_marked(v, out_of_bounds_));
    }
    bool are_in_one_body(int a, int b) const
    {
        return !rigid_.empty() && collision::are_in_one_body(rigid_[a], rigid_[b]);
    }
    bool are_candidates(const Record& record, bool is_edge_edge) const;
    bool may_meet(const std::array<int, 4>& v, bool is_edge_edge) const
    {
        return MayMeet{x_, trajectories_, margin_, candidates_.is_moving()}(v, is_edge_edge);
    }

    std::vector<Triangle> triangles_;
    std::vector<int> rigid_; ///< [vertices], or empty
    SurfaceEdges edges_;
    Candidates candidates_;
    Keeping keeping_;
    KeptPairs kept_;

    // The arguments of find.
    View<const Vec3> x_;
    Trajectories trajectories_;
    double margin_ = 0.0;
    View<const unsigned char> out_of_bounds_; ///< [vertices] only pairs with a marked vertex; empty: all

    // Memory kept between searches.
    std::vector<Found> found_; ///< by task
    int task_count_ = 0;       ///< tasks of this search
    OrderedRecords vertex_triangle_, edge_edge_;
};

NearPairs::Search::Search(View<const Triangle> triangle_list, View<const Vec3> positions,
                          std::vector<int> rigid, Keeping keeping)
    : triangles_(triangle_list.begin(), triangle_list.end()), rigid_(std::move(rigid)),
      edges_(build_surface_edges(triangle_list, positions.size())),
      candidates_(triangles_, edges_, positions, rigid_), keeping_(keeping),
      kept_(mean_length(edges_, positions, rigid_))
{
}

void NearPairs::Search::try_edges(int e, int f, Found& found) const
{
    if (are_in_one_body(edges_.vertex[e][0], edges_.vertex[f][0]))
        return;
    const auto [low, high] = std::minmax(e, f);
    const std::array<int, 4> v = corners()(low, high, true);
    if (is_wanted(v) && !share_vertex(v, true) && may_meet(v, true))
        found.edge_edge.push_back({low, high});
}

void NearPairs::Search::try_triangle(int p, int t, Found& found) const
{
    if (are_in_one_body(p, triangles_[t][0]))
        return;
    const std::array<int, 4> v = corners()(p, t, false);
    if (is_wanted(v) && !share_vertex(v, false) && may_meet(v, false))
        found.vertex_triangle.push_back({p, t});
}

void NearPairs::Search::find(View<const Vec3> x, const Trajectories& trajectories, double margin,
                             std::vector<NearPair>& out)
{
    using Plan = KeptPairs::Plan;
    const Plan plan = keeping_ == Keeping::kPairs ? kept_.plan(x, trajectories, margin) : Plan::kSearch;
    x_ = x;
    trajectories_ = trajectories;
    margin_ = margin;
    out_of_bounds_ = {};
    if (plan == Plan::kKeep)
        keep();
    candidates_.place(x, trajectories, margin);
    task_count_ = 0;
    if (plan == Plan::kSearch)
        search(trajectories.selected, Candidates::Prescribed::kPassive);
    else
        query_kept();
    order();
    report(out);
}

/// Searches with the wide margin and without motion, and starts a list.
void NearPairs::Search::keep()
{
    const StageScope stage("collision/cloth_keep");
    const Trajectories trajectories = std::exchange(trajectories_, {});
    const double margin = std::exchange(margin_, kept_.wide(margin_));
    candidates_.place(x_, trajectories_, margin_);
    task_count_ = 0;
    search({}, Candidates::Prescribed::kPassive);
    order();
    take(vertex_triangle_, false, kept_.change_vertex_triangle());
    take(edge_edge_, true, kept_.change_edge_edge());
    kept_.keep(x_, trajectories, margin);
    trajectories_ = trajectories;
    margin_ = margin;
}

/// Copies the records into `kept`, with distances.
void NearPairs::Search::take(const OrderedRecords& records, bool is_edge_edge,
                             std::vector<KeptPairs::Pair>& kept) const
{
    kept.resize(records.size());
    parallel_for(kCpu, "collision/cloth_kept_distances", records.size(), [&](int i) {
        const std::array<Vec3, 4> at =
            corners_of(corners()(records[i].first, records[i].second, is_edge_edge), x_);
        kept[i] = {records[i], closest_difference(closest_weights(is_edge_edge, at), at).norm()};
    });
}

/// Adds `count` tasks; returns their results, still empty.
View<NearPairs::Search::Found> NearPairs::Search::begin_tasks(int count)
{
    const int first = std::exchange(task_count_, task_count_ + count);
    found_.resize(std::max(found_.size(), size_t(task_count_)));
    const View<Found> begun = View<Found>(found_).subview(first, count);
    for (Found& found : begun) {
        found.vertex_triangle.clear();
        found.edge_edge.clear();
    }
    return begun;
}

/// Finds the records of pairs, task by task.
/// @param selected, prescribed  see Candidates::update
void NearPairs::Search::search(View<const unsigned char> selected, Candidates::Prescribed prescribed)
{
    candidates_.update(selected, prescribed);
    const View<Found> found = begin_tasks(candidates_.task_count());
    parallel_for(
        kCpu, "collision/cloth_pairs", found.size(),
        [&](int task) {
            candidates_.visit(
                task, [&](int e, int f) { try_edges(e, f, found[task]); },
                [&](int v, int t) { try_triangle(v, t, found[task]); });
        },
        1);
}

/// Selects from the kept pairs, and searches around out-of-bounds vertices only. Those of bodies meet cloth
/// that is not out of bounds.
void NearPairs::Search::query_kept()
{
    const StageScope stage("collision/cloth_kept");
    query_kept(kept_.vertex_triangle(), false);
    query_kept(kept_.edge_edge(), true);
    if (!kept_.has_out_of_bounds())
        return;
    out_of_bounds_ = kept_.out_of_bounds();
    if (trajectories_.selected.empty())
        search(out_of_bounds_, Candidates::Prescribed::kSelectable);
    else
        search(trajectories_.selected, Candidates::Prescribed::kPassive);
}

void NearPairs::Search::query_kept(View<const KeptPairs::Pair> kept, bool is_edge_edge)
{
    const View<Found> found = begin_tasks((kept.size() + kPairsOfTask - 1) / kPairsOfTask);
    parallel_for(
        kCpu, "collision/cloth_ask_kept", found.size(),
        [&](int task) {
            std::vector<Record>& records = is_edge_edge ? found[task].edge_edge : found[task].vertex_triangle;
            const int end = std::min(kept.size(), (task + 1) * kPairsOfTask);
            for (int i = task * kPairsOfTask; i < end; ++i) {
                const Record& record = kept[i].record;
                const std::array<int, 4> v = corners()(record.first, record.second, is_edge_edge);
                if (is_wanted(v) && kept_.may_meet(kept[i], v, is_edge_edge, margin_) &&
                    are_candidates(record, is_edge_edge) && may_meet(v, is_edge_edge))
                    records.push_back(record);
            }
        },
        1);
}

bool NearPairs::Search::are_candidates(const Record& record, bool is_edge_edge) const
{
    const auto [first, second] = record;
    return is_edge_edge ? candidates_.overlap(edges_.vertex[first], edges_.vertex[second])
                        : candidates_.overlap(std::array<int, 1>{first}, triangles_[second]);
}

void NearPairs::Search::order()
{
    const View<const Found> all = View<const Found>(found_).subview(0, task_count_);
    vertex_triangle_.order(x_.size(), all,
                           [](const Found& found) { return View<const Record>(found.vertex_triangle); });
    edge_edge_.order(edges_.edge_count(), all,
                     [](const Found& found) { return View<const Record>(found.edge_edge); });
}

/// Completes the pairs at x.
void NearPairs::Search::report(std::vector<NearPair>& out)
{
    const int triangle_count = vertex_triangle_.size();
    const int count = triangle_count + edge_edge_.size();
    out.resize(count);
    parallel_for(kCpu, "collision/cloth_facing", count, [&](int i) {
        const bool is_edge_edge = i >= triangle_count;
        const auto [first, second] = is_edge_edge ? edge_edge_[i - triangle_count] : vertex_triangle_[i];
        out[i] = near_pair_at(triangles_, view_of(edges_), x_, first, second, is_edge_edge);
    });
}

NearPairs::NearPairs(View<const Triangle> triangles, View<const Vec3> positions, std::vector<int> rigid,
                     Keeping keeping)
    : search_(std::make_unique<Search>(triangles, positions, std::move(rigid), keeping))
{
}
NearPairs::~NearPairs() = default;
NearPairs::NearPairs(NearPairs&&) noexcept = default;
NearPairs& NearPairs::operator=(NearPairs&&) noexcept = default;

const SurfaceEdges& NearPairs::edges() const { return search_->edges(); }
SoupView NearPairs::soup() const { return search_->soup(); }

void NearPairs::find(View<const Vec3> x, const Trajectories& trajectories, double margin,
                     std::vector<NearPair>& out)
{
    search_->find(x, trajectories, margin, out);
}

} // namespace toile::collision
