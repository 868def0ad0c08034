#include "collision/cloth/near_pairs.h"

#include <algorithm>
#include <limits>

#include "collision/cloth/candidates.h"
#include "collision/cloth/facing.h"
#include "collision/cloth/ordered_records.h"
#include "collision/cloth/pair_geometry.h"
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

    void find(View<const Vec3> x, const Ways& ways, double margin, std::vector<NearPair>& out);
    const SurfaceEdges& edges() const { return edges_; }

    NearPair at(View<const Vec3> x, int first, int second, bool is_edge_edge) const;

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
    bool is_wanted(const std::array<int, 4>& v) const
    {
        const View<const unsigned char>& around = ways_.around;
        return around.empty() || around[v[0]] || around[v[1]] || around[v[2]] || around[v[3]];
    }
    bool are_in_one_body(int a, int b) const
    {
        return !rigid_.empty() && rigid_[a] >= 0 && rigid_[a] == rigid_[b];
    }
    bool may_meet(const std::array<int, 4>& v, bool is_edge_edge) const;

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

/// False only where the pair stays `margin` apart along the direction that separates it now: on a straight
/// way that is true throughout when it is at the end.
bool NearPairs::Search::may_meet(const std::array<int, 4>& v, bool is_edge_edge) const
{
    const int first = first_count(is_edge_edge);
    double slack[2] = {0.0, 0.0};
    if (!ways_.slack.empty())
        for (int k = 0; k < 4; ++k) {
            double& side = slack[k < first ? 0 : 1];
            side = std::max(side, ways_.slack[v[k]]);
        }
    const double margin = margin_ + slack[0] + slack[1];

    const std::array<Vec3, 4> x = corners_of(v, x_);
    const Vec3 difference = closest_difference(closest_weights(is_edge_edge, x), x);
    const double distance = difference.norm();
    if (distance <= margin)
        return true;
    if (!candidates_.is_moving())
        return false;
    const Vec3 n = difference / distance;
    double ahead = std::numeric_limits<double>::max(), behind = -ahead;
    for (int k = 0; k < 4; ++k) {
        const double height = n.dot(x[k] - x[3] + ways_.motion[v[k]]);
        if (k < first)
            ahead = std::min(ahead, height);
        else
            behind = std::max(behind, height);
    }
    return ahead - behind <= margin;
}

void NearPairs::Search::try_edges(int e, int f, Found& found) const
{
    if (are_in_one_body(edges_.vertex[e][0], edges_.vertex[f][0]))
        return;
    const auto [low, high] = std::minmax(e, f);
    const std::array<int, 4> v = edge_corners(low, high);
    if (is_wanted(v) && !share_vertex(v, 2) && may_meet(v, true))
        found.edge_edge.push_back({low, high});
}

void NearPairs::Search::try_triangle(int p, int t, Found& found) const
{
    if (are_in_one_body(p, triangles_[t][0]))
        return;
    const std::array<int, 4> v = triangle_corners(p, t);
    if (is_wanted(v) && !share_vertex(v, 1) && may_meet(v, false))
        found.vertex_triangle.push_back({p, t});
}

NearPair NearPairs::Search::at(View<const Vec3> x, int first, int second, bool is_edge_edge) const
{
    NearPair pair{};
    pair.first = first;
    pair.second = second;
    pair.is_edge_edge = is_edge_edge;
    pair.vertex = is_edge_edge ? edge_corners(first, second) : triangle_corners(first, second);
    const std::array<Vec3, 4> corner = corners_of(pair.vertex, x);
    pair.weight = closest_weights(is_edge_edge, corner);
    const Vec3 difference = closest_difference(pair.weight, corner);
    pair.distance = difference.norm();
    pair.normal = separating_direction(is_edge_edge, corner, pair.weight, difference);
    pair.is_facing = is_edge_edge ? is_facing_edges(edges_, triangles_, x, pair, first, second)
                                  : is_facing_triangle(edges_, triangles_, x, pair, second);
    return pair;
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
        out[i] = at(x_, first, second, is_edge_edge);
    });
}

NearPairs::NearPairs(View<const Triangle> triangles, View<const Vec3> positions, std::vector<int> rigid)
    : search_(std::make_unique<Search>(triangles, positions, std::move(rigid)))
{
}
NearPairs::~NearPairs() = default;
NearPairs::NearPairs(NearPairs&&) noexcept = default;
NearPairs& NearPairs::operator=(NearPairs&&) noexcept = default;

NearPair NearPairs::at(View<const Vec3> x, const NearPair& pair) const
{
    return search_->at(x, pair.first, pair.second, pair.is_edge_edge);
}

const SurfaceEdges& NearPairs::edges() const { return search_->edges(); }

void NearPairs::find(View<const Vec3> x, const Ways& ways, double margin, std::vector<NearPair>& out)
{
    search_->find(x, ways, margin, out);
}

} // namespace toile
