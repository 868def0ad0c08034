#include "collision/cloth/near_pairs.h"

#include <algorithm>

#include "collision/cloth/candidates.h"
#include "collision/cloth/ordered_records.h"
#include "collision/cloth/pair_rules.h"
#include "core/backend/parallel.h"

namespace toile {

class NearPairs::Search {
public:
    Search(View<const Triangle> triangle_list, View<const Vec3> positions, std::vector<int> rigid);

    void find(View<const Vec3> x, const Ways& ways, double margin, std::vector<NearPair>& out);
    const SurfaceEdges& edges() const { return edges_; }
    SoupView soup() const { return {triangles_, view_of(edges_)}; }

private:
    /// What one task found: (vertex, triangle) and (edge, edge).
    struct Found {
        std::vector<Record> vertex_triangle, edge_edge;
    };

    void search();
    void report(std::vector<NearPair>& out);
    void try_edges(int e, int f, Found& found) const;
    void try_triangle(int v, int t, Found& found) const;

    PairCorners corners() const { return {triangles_, edges_.vertex}; }
    bool is_wanted(const std::array<int, 4>& v) const
    {
        const View<const unsigned char>& around = ways_.around;
        return around.empty() || around[v[0]] || around[v[1]] || around[v[2]] || around[v[3]];
    }
    bool are_in_one_body(int a, int b) const
    {
        return !rigid_.empty() && rigid_[a] >= 0 && rigid_[a] == rigid_[b];
    }
    bool may_meet(const std::array<int, 4>& v, bool is_edge_edge) const
    {
        return MayMeet{x_, ways_, margin_, candidates_.is_moving()}(v, is_edge_edge);
    }

    std::vector<Triangle> triangles_;
    std::vector<int> rigid_; ///< [vertices], or empty
    SurfaceEdges edges_;
    Candidates candidates_;

    // The arguments of find.
    View<const Vec3> x_;
    Ways ways_;
    double margin_ = 0.0;

    // Memory kept between searches.
    std::vector<Found> found_;
    OrderedRecords vertex_triangle_, edge_edge_;
};

NearPairs::Search::Search(View<const Triangle> triangle_list, View<const Vec3> positions,
                          std::vector<int> rigid)
    : triangles_(triangle_list.begin(), triangle_list.end()), rigid_(std::move(rigid)),
      edges_(build_surface_edges(triangle_list, positions.size())), candidates_(triangles_, edges_, positions)
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

void NearPairs::Search::find(View<const Vec3> x, const Ways& ways, double margin, std::vector<NearPair>& out)
{
    x_ = x;
    ways_ = ways;
    margin_ = margin;
    candidates_.update(x, ways, margin);
    search();
    report(out);
}

/// Numbers of the pairs, task by task.
void NearPairs::Search::search()
{
    found_.resize(std::max(found_.size(), size_t(candidates_.task_count())));
    for (Found& found : found_) {
        found.vertex_triangle.clear();
        found.edge_edge.clear();
    }
    parallel_for(
        kCpu, "collision/cloth_pairs", candidates_.task_count(),
        [&](int task) {
            Found& found = found_[task];
            candidates_.visit(
                task, [&](int e, int f) { try_edges(e, f, found); },
                [&](int v, int t) { try_triangle(v, t, found); });
        },
        1);
}

/// The pairs in order, and what there is to know about each.
void NearPairs::Search::report(std::vector<NearPair>& out)
{
    vertex_triangle_.order(x_.size(), found_,
                           [](const Found& found) { return View<const Record>(found.vertex_triangle); });
    edge_edge_.order(edges_.edge_count(), found_,
                     [](const Found& found) { return View<const Record>(found.edge_edge); });
    const int triangle_count = vertex_triangle_.size();
    const int count = triangle_count + edge_edge_.size();
    out.resize(count);
    parallel_for(kCpu, "collision/cloth_facing", count, [&](int i) {
        const bool is_edge_edge = i >= triangle_count;
        const auto [first, second] = is_edge_edge ? edge_edge_[i - triangle_count] : vertex_triangle_[i];
        out[i] = near_pair_at(triangles_, view_of(edges_), x_, first, second, is_edge_edge);
    });
}

NearPairs::NearPairs(View<const Triangle> triangles, View<const Vec3> positions, std::vector<int> rigid)
    : search_(std::make_unique<Search>(triangles, positions, std::move(rigid)))
{
}
NearPairs::~NearPairs() = default;
NearPairs::NearPairs(NearPairs&&) noexcept = default;
NearPairs& NearPairs::operator=(NearPairs&&) noexcept = default;

const SurfaceEdges& NearPairs::edges() const { return search_->edges(); }
SoupView NearPairs::soup() const { return search_->soup(); }

void NearPairs::find(View<const Vec3> x, const Ways& ways, double margin, std::vector<NearPair>& out)
{
    search_->find(x, ways, margin, out);
}

} // namespace toile
