#include "collision/check/gap_meter.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "collision/check/crossing_box_tree.h"
#include "collision/geometry/distance.h"
#include "collision/geometry/surface_edges.h"
#include "core/compute/parallel.h"

namespace toile::collision {

namespace {

/// Fraction of the rest distance below which pairs of one piece count [-].
constexpr double kFoldedFraction = 0.5;

/// Lowest vertex connected to each vertex through triangles.
std::vector<int> connected_pieces(View<const Triangle> triangles, int vertex_count)
{
    std::vector<int> leader(vertex_count);
    std::iota(leader.begin(), leader.end(), 0);
    const auto find = [&](int v) {
        while (leader[v] != v)
            v = leader[v] = leader[leader[v]];
        return v;
    };
    for (const Triangle& t : triangles)
        for (const int k : {1, 2}) {
            const int a = find(t[0]), b = find(t[k]);
            leader[std::max(a, b)] = std::min(a, b);
        }
    for (int v = 0; v < vertex_count; ++v)
        leader[v] = find(v);
    return leader;
}

/// Box around these vertices; empty if one is not finite.
template <typename Corners>
Bounds box_of(const Corners& corners, View<const Vec3> x)
{
    Bounds box;
    for (const int v : corners) {
        if (!x[v].allFinite())
            return {};
        box.extend(x[v]);
    }
    return box;
}

template <typename Items>
std::vector<Bounds> boxes_of(const Items& items, View<const Vec3> x)
{
    std::vector<Bounds> boxes(items.size());
    parallel_for(kCpu, "crossings/boxes", int(items.size()), [&](int i) { boxes[i] = box_of(items[i], x); });
    return boxes;
}

Bounds inflated(Bounds box, double by)
{
    box.lower.array() -= by;
    box.upper.array() += by;
    return box;
}

double distance_to_triangle(View<const Vec3> x, int v, const Triangle& t)
{
    return std::sqrt(closest_on_triangle(x[v], x[t[0]], x[t[1]], x[t[2]]).distance2);
}

double distance_of_edges(View<const Vec3> x, const std::array<int, 2>& a, const std::array<int, 2>& b)
{
    return std::sqrt(closest_on_segments(x[a[0]], x[a[1]], x[b[0]], x[b[1]]).distance2);
}

void keep_nearer(std::optional<GapMeter::Gap>& best, const std::optional<GapMeter::Gap>& found)
{
    if (found && (!best || found->distance < best->distance))
        best = found;
}

/// Minimum distance between `boxes` and the tree's boxes. Each box searches within the smallest distance that
/// its chunk has found so far.
/// @param distance  (i, k, limit) returns a distance that counts below limit, or limit
template <typename Distance, typename Point>
std::optional<GapMeter::Gap> nearest(View<const Bounds> boxes, const CrossingBoxTree& tree, double reach,
                                     const Distance& distance, const Point& point)
{
    std::vector<GapMeter::Gap> of_chunks;
    parallel_append(
        kCpu, "crossings/gap", boxes.size(),
        [&](int begin, int end, std::vector<GapMeter::Gap>& found) {
            GapMeter::Gap best{reach, Vec3::Zero()};
            std::vector<int> near;
            for (int i = begin; i < end; ++i) {
                if (boxes[i].empty())
                    continue;
                near.clear();
                tree.find(inflated(boxes[i], best.distance), near);
                for (const int k : near)
                    if (const double d = distance(i, k, best.distance); d < best.distance)
                        best = {d, point(i)};
            }
            if (best.distance < reach)
                found.push_back(best);
        },
        of_chunks);
    std::optional<GapMeter::Gap> best;
    for (const GapMeter::Gap& gap : of_chunks)
        keep_nearer(best, gap);
    return best;
}

} // namespace

GapMeter::GapMeter(View<const Triangle> triangles, View<const Vec3> rest)
    : triangles_(triangles.begin(), triangles.end()),
      edges_(build_surface_edges(triangles, rest.size()).vertex), rest_(rest.begin(), rest.end()),
      piece_of_(connected_pieces(triangles, rest.size()))
{
}

std::optional<GapMeter::Gap> GapMeter::measure(View<const Vec3> x, double reach) const
{
    const StageScope stage("crossings/min_gap");
    std::optional<Gap> best = nearest_triangle(x, reach);
    keep_nearer(best, nearest_edges(x, best ? best->distance : reach));
    return best;
}

std::optional<GapMeter::Gap> GapMeter::nearest_triangle(View<const Vec3> x, double reach) const
{
    const CrossingBoxTree tree(boxes_of(triangles_, x));
    std::vector<Bounds> boxes(x.size());
    for (const Triangle& t : triangles_)
        for (const int v : t)
            if (boxes[v].empty())
                boxes[v] = box_of(std::array<int, 1>{v}, x);
    const auto distance = [&](int v, int t, double limit) {
        const Triangle& corner = triangles_[t];
        if (corner[0] == v || corner[1] == v || corner[2] == v)
            return limit;
        const double d = distance_to_triangle(x, v, corner);
        const bool is_one_piece = piece_of_[v] == piece_of_[corner[0]];
        return d < limit && !(is_one_piece && d >= kFoldedFraction * distance_to_triangle(rest_, v, corner))
                   ? d
                   : limit;
    };
    return nearest(boxes, tree, reach, distance, [&](int v) { return x[v]; });
}

std::optional<GapMeter::Gap> GapMeter::nearest_edges(View<const Vec3> x, double reach) const
{
    const std::vector<Bounds> boxes = boxes_of(edges_, x);
    const CrossingBoxTree tree(boxes);
    const auto distance = [&](int i, int k, double limit) {
        const std::array<int, 2>&a = edges_[i], &b = edges_[k];
        if (k <= i || a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1])
            return limit;
        const double d = distance_of_edges(x, a, b);
        const bool is_one_piece = piece_of_[a[0]] == piece_of_[b[0]];
        return d < limit && !(is_one_piece && d >= kFoldedFraction * distance_of_edges(rest_, a, b)) ? d
                                                                                                     : limit;
    };
    return nearest(boxes, tree, reach, distance, [&](int i) { return x[edges_[i][0]]; });
}

} // namespace toile::collision
