#include "collision/check/penetration.h"

#include <algorithm>

#include "core/compute/parallel.h"

namespace toile::collision {

namespace {

/// Distance in front of a surface at which its outside is probed [m]. Well above the rays' rounding (1e-6),
/// well below any gap between body parts that matters.
constexpr double kProbe = 2e-5;

/// Accuracy of a triangle's depth in a solid [m], and the maximum number of halvings to reach it.
constexpr double kDepthTolerance = 1e-7;
constexpr int kMaxHalvings = 64;

/// Maximum of `known` and the depth of triangle (a, b, c). The signed distance of a convex solid is convex,
/// so its gradient at the middle bounds the depth of the whole triangle. If the bound is inconclusive, the
/// longest edge is halved: long triangles become round ones before their number grows.
double deeper(const Shape& shape, const Eigen::Isometry3d& pose, const Vec3& a, const Vec3& b, const Vec3& c,
              double known, int halvings)
{
    const Vec3 middle = (a + b + c) / 3.0;
    const ShapePoint at = closest(shape, pose, middle);
    known = std::max(known, -at.signed_distance);
    const double steepest =
        std::min({at.normal.dot(a - middle), at.normal.dot(b - middle), at.normal.dot(c - middle)});
    if (-at.signed_distance - steepest <= known + kDepthTolerance || halvings == 0)
        return known;
    const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
    if (bc > ab && bc >= ca)
        return deeper(shape, pose, b, c, a, known, halvings);
    if (ca > ab)
        return deeper(shape, pose, c, a, b, known, halvings);
    const Vec3 half = 0.5 * (a + b);
    known = deeper(shape, pose, a, half, c, known, halvings - 1);
    return deeper(shape, pose, half, b, c, known, halvings - 1);
}

} // namespace

ClothSamples::ClothSamples(View<const Triangle> triangles, int vertex_count)
    : triangles_(triangles.begin(), triangles.end()), edges_(build_surface_edges(triangles, vertex_count)),
      vertex_count_(vertex_count), is_on_border_(vertex_count + triangles.size() + edges_.vertex.size(), 0)
{
    for (int e = 0; e < edges_.edge_count(); ++e)
        if (edges_.triangles.of(e).size() == 1) {
            is_on_border_[vertex_count + triangles.size() + e] = 1;
            for (const int v : edges_.vertex[e])
                is_on_border_[v] = 1;
        }
}

std::vector<Vec3> ClothSamples::at(View<const Vec3> x) const
{
    std::vector<Vec3> samples(x.begin(), x.end());
    samples.reserve(x.size() + triangles_.size() + edges_.vertex.size());
    for (const Triangle& corner : triangles_)
        samples.push_back((x[corner[0]] + x[corner[1]] + x[corner[2]]) / 3.0);
    for (const auto& [a, b] : edges_.vertex)
        samples.push_back(0.5 * (x[a] + x[b]));
    return samples;
}

std::string ClothSamples::name(int sample) const
{
    if (sample < vertex_count_)
        return "vertex " + std::to_string(sample);
    const int triangle = sample - vertex_count_;
    if (triangle < int(triangles_.size()))
        return "triangle " + std::to_string(triangle);
    const std::array<int, 2>& edge = edges_.vertex[triangle - int(triangles_.size())];
    return "edge " + std::to_string(edge[0]) + "-" + std::to_string(edge[1]);
}

/// Sample inside the mesh.
struct PenetrationMeter::Inside {
    int sample = -1; ///< -1: outside
    Vec3 point = Vec3::Zero();
    SurfacePoint nearest;
    bool is_excluded = false;
};

PenetrationMeter::PenetrationMeter(View<const Triangle> triangles, View<const Vec3> positions,
                                   const Settings& settings)
    : settings_(settings), surface_(triangles, positions), bounds_(bounds(positions)),
      is_closed_(surface_.edges().is_closed), is_border_vertex_(positions.size(), 0)
{
    rays_.add(positions, triangles);
    rays_.commit();
    for (int e = 0; e < surface_.edges().edge_count(); ++e)
        if (surface_.edges().triangles.of(e).size() == 1)
            for (const int v : surface_.edges().vertex[e])
                is_border_vertex_[v] = 1;
}

void PenetrationMeter::move(View<const Vec3> positions)
{
    surface_.update(positions);
    rays_.update(0, positions);
    rays_.commit();
    bounds_ = bounds(positions);
}

Penetration PenetrationMeter::measure(View<const Vec3> samples, Sides* sides) const
{
    const StageScope stage("collision/penetration");
    std::vector<Inside> inside = is_closed_ ? find_inside(samples)
                                 : sides    ? find_beyond(samples, *sides)
                                            : std::vector<Inside>{};
    std::erase_if(inside, [](const Inside& item) { return item.sample < 0; });
    if (is_closed_)
        exclude_pinched(inside);

    Penetration result;
    for (const Inside& item : inside) {
        const double depth = item.nearest.distance();
        if (item.is_excluded) {
            ++result.excluded_count;
            result.deepest_excluded = std::max(result.deepest_excluded, depth);
        } else if (depth > result.max_depth) {
            result.max_depth = depth;
            result.sample = item.sample;
            result.point = item.point;
        }
    }
    return result;
}

/// Samples with a positive winding number; a winding number above 1 excludes a sample at once.
std::vector<PenetrationMeter::Inside> PenetrationMeter::find_inside(View<const Vec3> samples) const
{
    std::vector<Inside> inside(samples.size());
    parallel_for(kCpu, "collision/penetration_winding", samples.size(), [&](int i) {
        const Vec3& p = samples[i];
        if (!((p.array() >= bounds_.lower.array()).all() && (p.array() <= bounds_.upper.array()).all()))
            return;
        const int winding = rays_.winding_number(p);
        if (winding > 0)
            inside[i] = {i, p, *surface_.closest(p), winding > 1};
    });
    return inside;
}

/// Samples that have come to the other side of an open surface. Beside its border no side is defined.
std::vector<PenetrationMeter::Inside> PenetrationMeter::find_beyond(View<const Vec3> samples,
                                                                    Sides& sides) const
{
    sides.resize(samples.size(), 0);
    std::vector<Inside> inside(samples.size());
    parallel_for(kCpu, "collision/penetration_sign", samples.size(), [&](int i) {
        if (!samples[i].allFinite())
            return;
        const std::optional<SurfacePoint> nearest = surface_.closest(samples[i], settings_.open_depth);
        if (!nearest || is_on_border(*nearest)) {
            sides[i] = 0;
            return;
        }
        const signed char side = nearest->signed_distance < 0.0 ? -1 : 1;
        if (sides[i] == 0)
            sides[i] = side;
        else if (side != sides[i])
            inside[i] = {i, samples[i], *nearest, false};
    });
    return inside;
}

bool PenetrationMeter::is_on_border(const SurfacePoint& at) const
{
    if (const int k = edge_of(at.feature); k >= 0) {
        const int edge = surface_.edges().triangle_edge[at.triangle][k];
        return surface_.edges().triangles.of(edge).size() == 1;
    }
    const int k = vertex_of(at.feature);
    return k >= 0 && is_border_vertex_[surface_.triangles()[at.triangle][k]];
}

bool PenetrationMeter::is_buried(int triangle) const
{
    if (!is_closed_)
        return false;
    constexpr double kTowardsCorner = 0.9; // [-] fraction of the path to a corner, which may lie in a crease
    const Triangle& corner = surface_.triangles()[triangle];
    Vec3 centroid = Vec3::Zero();
    for (const int v : corner)
        centroid += surface_.positions()[v] / 3.0;
    const Vec3 outwards = kProbe * surface_.face_normal(triangle);
    if (rays_.winding_number(centroid + outwards) > 0)
        return true;
    return std::any_of(corner.begin(), corner.end(), [&](int v) {
        const Vec3 near_corner = centroid + kTowardsCorner * (surface_.positions()[v] - centroid);
        return rays_.winding_number(near_corner + outwards) > 0;
    });
}

/// Looks from the centroid and from near each corner, in front of the triangle.
bool PenetrationMeter::is_narrow(int triangle) const
{
    if (settings_.room <= 0.0)
        return false;
    constexpr double kInFront = 0.2; // [-] cosine with the normal: creases open sideways
    const View<const Vec3> x = surface_.positions();
    const Triangle& corner = surface_.triangles()[triangle];
    const Vec3 normal = surface_.face_normal(triangle);
    std::vector<int> near;
    for (int k = 0; k < 4; ++k) {
        const Vec3 p = k < 3 ? x[corner[k]] : Vec3((x[corner[0]] + x[corner[1]] + x[corner[2]]) / 3.0);
        surface_.triangles_within(p, settings_.room, near);
        for (const int t : near) {
            if (surface_.face_normal(t).dot(normal) >= 0.0)
                continue;
            const Triangle& other = surface_.triangles()[t];
            const Vec3 across = closest_on_triangle(p, x[other[0]], x[other[1]], x[other[2]]).point - p;
            if (normal.dot(across) > kInFront * across.norm())
                return true;
        }
    }
    return false;
}

bool PenetrationMeter::is_pinched(const Vec3& point, View<const char> marked) const
{
    std::vector<int> near;
    surface_.triangles_within(point, settings_.pinch_margin, near);
    return std::any_of(near.begin(), near.end(), [&](int t) {
        return (!marked.empty() && marked[t] != 0) || is_buried(t) || is_narrow(t);
    });
}

/// Excludes samples in pinches; see the class.
void PenetrationMeter::exclude_pinched(std::vector<Inside>& inside) const
{
    const double margin = settings_.pinch_margin;
    // Find the surface near each sample and near its exit.
    std::vector<std::vector<int>> nearby(inside.size());
    parallel_for(kCpu, "collision/penetration_exits", int(inside.size()), [&](int i) {
        if (inside[i].is_excluded)
            return;
        std::vector<int> more;
        surface_.triangles_within(inside[i].point, margin, nearby[i]);
        surface_.triangles_within(inside[i].nearest.point, margin, more);
        nearby[i].insert(nearby[i].end(), more.begin(), more.end());
    });

    // Find which triangles of it are buried; test each triangle once.
    std::vector<int> asked;
    for (const std::vector<int>& triangles : nearby)
        asked.insert(asked.end(), triangles.begin(), triangles.end());
    std::sort(asked.begin(), asked.end());
    asked.erase(std::unique(asked.begin(), asked.end()), asked.end());
    std::vector<char> buried(surface_.triangles().size(), 0);
    parallel_for(kCpu, "collision/penetration_buried", int(asked.size()),
                 [&](int i) { buried[asked[i]] = is_buried(asked[i]) || is_narrow(asked[i]); });

    parallel_for(kCpu, "collision/penetration_exits", int(inside.size()), [&](int i) {
        const SurfacePoint& exit = inside[i].nearest;
        if (rays_.winding_number(exit.point + kProbe * exit.normal) > 0 ||
            std::any_of(nearby[i].begin(), nearby[i].end(), [&](int t) { return buried[t] != 0; }))
            inside[i].is_excluded = true;
    });
}

double penetration_of_triangle(const Shape& shape, const Eigen::Isometry3d& pose, const Vec3& a,
                               const Vec3& b, const Vec3& c)
{
    double known = 0.0;
    for (const Vec3& x : {a, b, c})
        known = std::max(known, -closest(shape, pose, x).signed_distance);
    return deeper(shape, pose, a, b, c, known, kMaxHalvings);
}

} // namespace toile::collision
