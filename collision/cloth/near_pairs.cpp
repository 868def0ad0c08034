#include "collision/cloth/near_pairs.h"

#include <algorithm>

#include "collision/cloth/candidates.h"
#include "collision/cloth/facing.h"
#include "collision/cloth/ordered_records.h"
#include "collision/cloth/pair_geometry.h"
#include "collision/cloth/safe_motion.h"
#include "core/backend/parallel.h"

namespace toile {

namespace {

bool share_vertex(const std::array<int, 4>& v, int first_count)
{
    for (int a = 0; a < first_count; ++a)
        for (int b = first_count; b < 4; ++b)
            if (v[a] == v[b])
                return true;
    return false;
}

std::array<Vec3, 4> corners_of(const std::array<int, 4>& v, View<const Vec3> values)
{
    return {values[v[0]], values[v[1]], values[v[2]], values[v[3]]};
}

} // namespace

class NearPairs::Search {
public:
    Search(View<const Triangle> triangle_list, View<const Vec3> positions, std::vector<int> rigid);

    void find(View<const Vec3> x, View<const Vec3> motion, View<const double> slack, double margin,
              std::vector<NearPair>& out);

private:
    /// What one task found: (vertex, triangle) and (edge, edge).
    struct Found {
        std::vector<Record> vertex_triangle, edge_edge;
    };

    void search();
    void report(std::vector<NearPair>& out);
    void try_edges(int e, int f, Found& found) const;
    void try_triangle(int v, int t, Found& found) const;

    std::array<int, 4> edge_corners(int e, int f) const
    {
        const auto &a = edges_.vertex[e], &b = edges_.vertex[f];
        return {a[0], a[1], b[0], b[1]};
    }
    std::array<int, 4> triangle_corners(int v, int t) const
    {
        return {v, triangles_[t][0], triangles_[t][1], triangles_[t][2]};
    }
    bool are_in_one_body(int a, int b) const
    {
        return !rigid_.empty() && rigid_[a] >= 0 && rigid_[a] == rigid_[b];
    }
    bool may_meet(const std::array<int, 4>& v, bool is_edge_edge) const;
    NearPair make_pair(const std::array<int, 4>& v, bool is_edge_edge) const;

    std::vector<Triangle> triangles_;
    std::vector<int> rigid_; ///< [vertices], or empty
    SurfaceEdges edges_;
    Candidates candidates_;

    // The arguments of find.
    View<const Vec3> x_;
    View<const Vec3> motion_;
    View<const double> slack_;
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

/// False only where the pair stays `margin` apart along the direction that separates it now: on a straight
/// way that is true throughout when it is at the end.
bool NearPairs::Search::may_meet(const std::array<int, 4>& v, bool is_edge_edge) const
{
    double slack[2] = {0.0, 0.0};
    for (int k = 0; k < 4; ++k) {
        double& side = slack[k < first_count(is_edge_edge) ? 0 : 1];
        side = std::max(side, slack_[v[k]]);
    }
    const double margin = margin_ + slack[0] + slack[1];

    std::array<Vec3, 4> x = corners_of(v, x_);
    const Vec3 difference = closest_difference(closest_weights(is_edge_edge, x), x);
    const double distance = difference.norm();
    if (distance <= margin)
        return true;
    if (!candidates_.is_moving())
        return false;
    for (int k = 0; k < 4; ++k)
        x[k] += motion_[v[k]];
    return gap_along(difference / distance, is_edge_edge, x) <= margin;
}

void NearPairs::Search::try_edges(int e, int f, Found& found) const
{
    if (are_in_one_body(edges_.vertex[e][0], edges_.vertex[f][0]))
        return;
    const auto [low, high] = std::minmax(e, f);
    const std::array<int, 4> v = edge_corners(low, high);
    if (!share_vertex(v, 2) && may_meet(v, true))
        found.edge_edge.push_back({low, high});
}

void NearPairs::Search::try_triangle(int p, int t, Found& found) const
{
    if (are_in_one_body(p, triangles_[t][0]))
        return;
    const std::array<int, 4> v = triangle_corners(p, t);
    if (!share_vertex(v, 1) && may_meet(v, false))
        found.vertex_triangle.push_back({p, t});
}

NearPair NearPairs::Search::make_pair(const std::array<int, 4>& v, bool is_edge_edge) const
{
    const std::array<Vec3, 4> x = corners_of(v, x_);
    NearPair pair{};
    pair.vertex = v;
    pair.is_edge_edge = is_edge_edge;
    pair.weight = closest_weights(is_edge_edge, x);
    const Vec3 difference = closest_difference(pair.weight, x);
    pair.distance = difference.norm();
    pair.normal = separating_direction(is_edge_edge, x, pair.weight, difference);
    return pair;
}

void NearPairs::Search::find(View<const Vec3> x, View<const Vec3> motion, View<const double> slack,
                             double margin, std::vector<NearPair>& out)
{
    x_ = x;
    motion_ = motion;
    slack_ = slack;
    margin_ = margin;
    candidates_.update(x, motion, slack, margin);
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
        if (i < triangle_count) {
            const auto [p, t] = vertex_triangle_[i];
            out[i] = make_pair(triangle_corners(p, t), false);
            out[i].is_facing = is_facing_triangle(edges_, triangles_, x_, out[i], t);
        } else {
            const auto [e, f] = edge_edge_[i - triangle_count];
            out[i] = make_pair(edge_corners(e, f), true);
            out[i].is_facing = is_facing_edges(edges_, triangles_, x_, out[i], e, f);
        }
    });
}

NearPairs::NearPairs(View<const Triangle> triangles, View<const Vec3> positions, std::vector<int> rigid)
    : search_(std::make_unique<Search>(triangles, positions, std::move(rigid)))
{
}
NearPairs::~NearPairs() = default;
NearPairs::NearPairs(NearPairs&&) noexcept = default;
NearPairs& NearPairs::operator=(NearPairs&&) noexcept = default;

void NearPairs::find(View<const Vec3> x, View<const Vec3> motion, View<const double> slack, double margin,
                     std::vector<NearPair>& out)
{
    search_->find(x, motion, slack, margin, out);
}

} // namespace toile
