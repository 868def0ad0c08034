#include "collision/cloth/near_pairs.h"

#include <algorithm>

#include "collision/cloth/box_tree.h"
#include "collision/cloth/facing.h"
#include "collision/cloth/ordered_records.h"
#include "collision/cloth/pair_geometry.h"
#include "collision/cloth/primitive_boxes.h"
#include "collision/cloth/safe_motion.h"
#include "core/backend/parallel.h"

namespace toile {

namespace {

/// Tasks that the search is cut into, at least, where the tree is large enough.
constexpr int kTasks = 512;

/// The tree's boxes may grow by this factor in surface [-] before it is built anew. Rolling a flat,
/// axis-parallel sheet over costs up to 2.3 by itself.
constexpr double kWornOut = 2.5;

/// Single-precision slack of boxes, relative to the largest number in them [-]: several times the rounding of
/// a coordinate and of growing it (2^-24 each), so that no pair is missed.
constexpr double kFloatSlack = 1e-6;

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
    Search(View<const Triangle> triangle_list, View<const Vec3> positions);

    void find(View<const Vec3> x, View<const Vec3> motion, double margin, std::vector<NearPair>& out);

private:
    /// What one task found: (vertex, triangle) and (edge, edge).
    struct Found {
        std::vector<Record> vertex_triangle, edge_edge;
    };

    void set_points();
    void fill_leaf(int leaf);
    void refit();
    void rebuild();

    void meet(const BoxTree::Node& a, const BoxTree::Node& b, Found& found) const;
    void meet_edges(const BoxTree::Node& a, const BoxTree::Node& b, Found& found) const;
    void meet_vertices(const BoxTree::Node& a, const BoxTree::Node& b, Found& found) const;
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
    bool may_meet(const std::array<int, 4>& v, bool is_edge_edge) const;
    NearPair make_pair(const std::array<int, 4>& v, bool is_edge_edge) const;

    std::vector<Triangle> triangles_;
    SurfaceEdges edges_;
    BoxTree tree_;
    PrimitiveBoxes boxes_;
    double built_surface_ = -1.0; ///< [m^2] of the tree when it was built; negative: not yet

    // The arguments of find, and what follows from them.
    View<const Vec3> x_;
    View<const Vec3> motion_;
    double margin_ = 0.0;
    bool is_moving_ = false;  ///< some vertex moves otherwise than the others
    float box_margin_ = 0.0f; ///< [m] half the margin and the slack of single precision
    std::vector<MovingPoint> points_;

    // Memory kept between searches.
    std::vector<Box> leaf_boxes_;
    std::vector<BoxTree::NodePair> tasks_;
    std::vector<Found> found_;
    OrderedRecords vertex_triangle_, edge_edge_;
};

NearPairs::Search::Search(View<const Triangle> triangle_list, View<const Vec3> positions)
    : triangles_(triangle_list.begin(), triangle_list.end()),
      edges_(build_surface_edges(triangle_list, positions.size())), x_(positions), motion_(),
      points_(positions.size())
{
    set_points();
    rebuild();
}

/// Positions in single precision around the middle of all, motions without the one common to all.
void NearPairs::Search::set_points()
{
    if (x_.empty())
        return;
    Vec3 lower = x_[0], upper = x_[0];
    for (const Vec3& x : x_) {
        lower = lower.cwiseMin(x);
        upper = upper.cwiseMax(x);
    }
    const Vec3 center = 0.5 * (lower + upper);

    // The frame that moves with the mean motion. Exactly equal motions make no pair's distance shrink.
    Vec3 mean = Vec3::Zero();
    is_moving_ = std::any_of(motion_.begin(), motion_.end(), [&](const Vec3& m) { return m != motion_[0]; });
    if (is_moving_)
        mean = parallel_sum(kCpu, motion_.size(), mean, [&](int v) { return motion_[v]; }) / motion_.size();

    parallel_for(kCpu, "collision/cloth_points", x_.size(), [&](int v) {
        const Eigen::Vector3f from = (x_[v] - center).cast<float>();
        const Eigen::Vector3f to = is_moving_ ? (x_[v] - center + motion_[v] - mean).cast<float>() : from;
        for (int k = 0; k < 3; ++k)
            points_[v].lower[k] = std::min(from[k], to[k]), points_[v].upper[k] = std::max(from[k], to[k]);
    });
    float farthest = 0.0f;
    for (const MovingPoint& point : points_)
        for (int k = 0; k < 3; ++k)
            farthest = std::max({farthest, -point.lower[k], point.upper[k]});
    const double largest = farthest + margin_;
    box_margin_ = float(0.5 * margin_ + kFloatSlack * largest);
}

void NearPairs::Search::fill_leaf(int leaf)
{
    const auto fill = [&](PrimitiveBoxes::Kind& kind, const auto& box_of) {
        for (int b = kind.first_block[leaf]; b < kind.first_block[leaf + 1]; ++b)
            for (int lane = 0; lane < BoxBlock::kCount; ++lane)
                if (const int item = kind.item_of(b, lane); item >= 0)
                    kind.block[b].set(lane, box_of(item));
    };
    fill(boxes_.edges, [&](int e) {
        const auto& v = edges_.vertex[e];
        return box_around(box_margin_, points_[v[0]], points_[v[1]]);
    });
    fill(boxes_.vertices, [&](int v) { return box_around(box_margin_, points_[v]); });
    Box all;
    fill(boxes_.triangles, [&](int t) {
        const Triangle& v = triangles_[t];
        const Box box = box_around(box_margin_, points_[v[0]], points_[v[1]], points_[v[2]]);
        all.add(box);
        return box;
    });
    leaf_boxes_[leaf] = all;
}

void NearPairs::Search::refit()
{
    leaf_boxes_.resize(tree_.leaf_count());
    parallel_for(kCpu, "collision/cloth_refit", tree_.leaf_count(), [&](int leaf) { fill_leaf(leaf); });
    tree_.refit(leaf_boxes_);
}

void NearPairs::Search::rebuild()
{
    const StageScope stage("collision/cloth_rebuild");
    std::vector<Box> items(triangles_.size());
    for (size_t t = 0; t < items.size(); ++t) {
        const Triangle& v = triangles_[t];
        items[t] = box_around(0.0f, points_[v[0]], points_[v[1]], points_[v[2]]);
    }
    tree_.build(items);
    boxes_.assign(tree_, edges_, triangles_);
    refit();
    built_surface_ = tree_.surface(box_margin_);
}

/// False only where the pair stays `margin` apart along the direction that separates it now: straight motion
/// keeps that true on all of the way when it is true at its end.
bool NearPairs::Search::may_meet(const std::array<int, 4>& v, bool is_edge_edge) const
{
    std::array<Vec3, 4> x = corners_of(v, x_);
    const Vec3 difference = closest_difference(closest_weights(is_edge_edge, x), x);
    const double distance = difference.norm();
    if (distance <= margin_)
        return true;
    if (!is_moving_)
        return false;
    for (int k = 0; k < 4; ++k)
        x[k] += motion_[v[k]];
    return gap_along(difference / distance, is_edge_edge, x) <= margin_;
}

void NearPairs::Search::try_edges(int e, int f, Found& found) const
{
    const auto [low, high] = std::minmax(e, f);
    const std::array<int, 4> v = edge_corners(low, high);
    if (!share_vertex(v, 2) && may_meet(v, true))
        found.edge_edge.push_back({low, high});
}

void NearPairs::Search::try_triangle(int p, int t, Found& found) const
{
    const std::array<int, 4> v = triangle_corners(p, t);
    if (!share_vertex(v, 1) && may_meet(v, false))
        found.vertex_triangle.push_back({p, t});
}

void NearPairs::Search::meet_edges(const BoxTree::Node& a, const BoxTree::Node& b, Found& found) const
{
    const PrimitiveBoxes::Kind& edges = boxes_.edges;
    const bool is_same = a.leaf == b.leaf;
    for (int i = edges.first_block[a.leaf]; i < edges.first_block[a.leaf + 1]; ++i)
        for_each_lane(edges.block[i].overlaps(b.box), [&](int lane) {
            const Box box = edges.block[i].get(lane);
            const int e = edges.item_of(i, lane);
            for (int j = is_same ? i : edges.first_block[b.leaf]; j < edges.first_block[b.leaf + 1]; ++j)
                for_each_lane(edges.block[j].overlaps(box), [&](int other) {
                    if (!is_same || j > i || other > lane)
                        try_edges(e, edges.item_of(j, other), found);
                });
        });
}

void NearPairs::Search::meet_vertices(const BoxTree::Node& a, const BoxTree::Node& b, Found& found) const
{
    const PrimitiveBoxes::Kind &vertices = boxes_.vertices, &triangles = boxes_.triangles;
    for (int i = vertices.first_block[a.leaf]; i < vertices.first_block[a.leaf + 1]; ++i)
        for_each_lane(vertices.block[i].overlaps(b.box), [&](int lane) {
            const Box box = vertices.block[i].get(lane);
            const int v = vertices.item_of(i, lane);
            for (int j = triangles.first_block[b.leaf]; j < triangles.first_block[b.leaf + 1]; ++j)
                for_each_lane(triangles.block[j].overlaps(box),
                              [&](int other) { try_triangle(v, triangles.item_of(j, other), found); });
        });
}

void NearPairs::Search::meet(const BoxTree::Node& a, const BoxTree::Node& b, Found& found) const
{
    meet_edges(a, b, found);
    meet_vertices(a, b, found);
    if (a.leaf != b.leaf)
        meet_vertices(b, a, found);
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

void NearPairs::Search::find(View<const Vec3> x, View<const Vec3> motion, double margin,
                             std::vector<NearPair>& out)
{
    x_ = x;
    motion_ = motion;
    margin_ = margin;
    set_points();
    refit();
    if (tree_.surface(box_margin_) > kWornOut * built_surface_)
        rebuild();

    // Pairs by number, from tasks that do not depend on the threads.
    tree_.pairs_of_nodes(kTasks, tasks_);
    found_.resize(std::max(found_.size(), tasks_.size()));
    for (Found& found : found_) {
        found.vertex_triangle.clear();
        found.edge_edge.clear();
    }
    parallel_for(
        kCpu, "collision/cloth_pairs", int(tasks_.size()),
        [&](int task) {
            tree_.descend(tasks_[task],
                          [&](const BoxTree::Node& a, const BoxTree::Node& b) { meet(a, b, found_[task]); });
        },
        1);

    // In order, and what there is to know about each.
    vertex_triangle_.order(x.size(), found_,
                           [](const Found& found) { return View<const Record>(found.vertex_triangle); });
    edge_edge_.order(edges_.edge_count(), found_,
                     [](const Found& found) { return View<const Record>(found.edge_edge); });
    const int triangle_count = vertex_triangle_.size();
    out.resize(size_t(triangle_count + edge_edge_.size()));
    parallel_for(kCpu, "collision/cloth_facing", int(out.size()), [&](int i) {
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

NearPairs::NearPairs(View<const Triangle> triangles, View<const Vec3> positions)
    : search_(std::make_unique<Search>(triangles, positions))
{
}
NearPairs::~NearPairs() = default;
NearPairs::NearPairs(NearPairs&&) noexcept = default;
NearPairs& NearPairs::operator=(NearPairs&&) noexcept = default;

void NearPairs::find(View<const Vec3> x, View<const Vec3> motion, double margin, std::vector<NearPair>& out)
{
    search_->find(x, motion, margin, out);
}

} // namespace toile
