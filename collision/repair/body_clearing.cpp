#include "collision/repair/body_clearing.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <Eigen/Geometry>

#include "collision/check/find_crossings.h"
#include "collision/geometry/shape_surface.h"
#include "core/compute/parallel.h"

namespace toile::collision {

namespace {

/// Growth of the bodies per increment [m]: less than the cloth's edges, so that the cloth can follow.
constexpr double kIncrement = 0.001;
constexpr int kMaxIncrements = 60;

/// Sweeps of relaxation per increment.
constexpr int kSweeps = 4;

/// Height of the band of cloth that is advected, over the depth to overcome [-]. Within it distances from the
/// body shrink by 1 / (1 + kBand) at most.
constexpr double kBand = 2.0;

/// Reach of the growth along the body, over the depth [-].
constexpr double kReach = 4.0;

/// Height [m] of a body's vertex above the cloth beyond which it belongs to another part of the body. kTipGap
/// is the distance that cloth keeps in front of a vertex [m].
constexpr double kMaxTip = 0.004;
constexpr double kTipGap = 0.0003;

/// Distance in front of a face [m] at which another part of the body is looked for.
constexpr double kInFront = 2e-5;

/// Depth of facets below a round shape [m].
constexpr double kSag = 0.0001;

/// Largest push of a vertex off crossings, and sum of them [m]: between parts of a body there may be no way
/// out.
constexpr double kMaxPush = 0.002, kMaxPushed = 0.005;

/// Shortest displacement that takes a triangle `a` off a triangle `b` of a body, which it crosses: above its
/// plane, or until `b` is below that of `a`.
Vec3 way_off(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b)
{
    const auto normal_of = [](const std::array<Vec3, 3>& t) {
        return Vec3((t[1] - t[0]).cross(t[2] - t[0]).normalized());
    };
    const Vec3 out = normal_of(b);
    const Vec3 own = normal_of(a).dot(out) < 0.0 ? Vec3(-normal_of(a)) : normal_of(a);
    double below = 0.0, above = 0.0;
    for (int k = 0; k < 3; ++k) {
        below = std::max(below, -out.dot(a[k] - b[0]));
        above = std::max(above, own.dot(b[k] - a[0]));
    }
    return below <= above ? Vec3((below + kTipGap) * out) : Vec3((above + kTipGap) * own);
}

/// Adds a displacement to the moves of vertices: of several, the longest decides along each direction.
/// @param direction  unit
void add_move(const std::array<int, 3>& vertices, double length, const Vec3& direction,
              const std::vector<char>& fixed, std::vector<Vec3>& move)
{
    for (const int v : vertices) {
        if (v < 0 || fixed[v] != 0)
            continue;
        const double served = move[v].dot(direction);
        if (served < length)
            move[v] += (length - served) * direction;
    }
}

} // namespace

BodyClearing::BodyClearing(const JoinedCloths& cloths, std::vector<ContactCollider> bodies)
    : cloths_(cloths), bodies_(std::move(bodies))
{
    for (size_t b = 0; b < bodies_.size(); ++b) {
        if (bodies_[b].mesh != nullptr) {
            add_surface(int(b), bodies_[b].mesh->triangles(), bodies_[b].mesh->x_t1());
            continue;
        }
        TriangleMesh facets = shape_surface(bodies_[b].shape->shape(), kSag);
        for (Vec3& p : facets.positions)
            p = bodies_[b].shape->pose() * p;
        add_surface(int(b), facets.triangles, facets.positions);
    }
}

void BodyClearing::add_surface(int body, View<const Triangle> triangles, View<const Vec3> x)
{
    const Triangle first = Triangle::Constant(int(surface_x_.size()));
    for (const Triangle& t : triangles)
        surface_triangles_.push_back(t + first);
    body_of_.resize(surface_triangles_.size(), body);
    surface_x_.insert(surface_x_.end(), x.begin(), x.end());
}

/// True if there is another part of a closed body in front of a face, at p.
bool BodyClearing::is_buried(int face, const Vec3& p) const
{
    if (!rays_) {
        rays_.emplace();
        for (const ContactCollider& body : bodies_)
            if (body.mesh != nullptr && body.mesh->surface().edges().is_closed)
                rays_->add(body.mesh->x_t1(), body.mesh->triangles());
        rays_->commit();
    }
    const Triangle& t = surface_triangles_[face];
    const Vec3 normal = (surface_x_[t[1]] - surface_x_[t[0]]).cross(surface_x_[t[2]] - surface_x_[t[0]]);
    return rays_->winding_number(p + kInFront * normal.normalized()) > 0;
}

std::vector<InsideSample> BodyClearing::inside(View<const Vec3> x, double depth) const
{
    return samples_below(x, [&](const InsideSample&) { return -depth; });
}

std::vector<int> BodyClearing::nearer(View<const Vec3> x, double fraction) const
{
    std::vector<int> near;
    for (const InsideSample& sample : movable_below(x, fraction)) {
        if (sample.proximity.signed_distance < -kTouchDepth)
            continue;
        std::copy_if(sample.vertex.begin(), sample.vertex.end(), std::back_inserter(near),
                     [&](int v) { return v >= 0 && cloths_.fixed[v] == 0; });
    }
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    return near;
}

/// Samples that can move, nearer to a body than a fraction of their gap [-].
std::vector<InsideSample> BodyClearing::movable_below(View<const Vec3> x, double gap_fraction) const
{
    return samples_below(x, [&](const InsideSample& sample) {
        return can_move(sample.vertex) ? gap_fraction * cloths_.gap[sample.vertex[0]]
                                       : -std::numeric_limits<double>::infinity();
    });
}

bool BodyClearing::can_move(const std::array<int, 3>& vertices) const
{
    return std::any_of(vertices.begin(), vertices.end(),
                       [&](int v) { return v >= 0 && cloths_.fixed[v] == 0; });
}

/// Sample of an index: vertices first, then centroids of triangles, then midpoints of edges.
InsideSample BodyClearing::sample_at(View<const Vec3> x, int index) const
{
    InsideSample sample;
    const int triangle = index - x.size();
    const int edge = triangle - int(cloths_.triangles.size());
    if (triangle < 0) {
        sample.vertex = {index, -1, -1};
        sample.point = x[index];
    } else if (edge < 0) {
        const Triangle& corner = cloths_.triangles[triangle];
        sample.vertex = {corner[0], corner[1], corner[2]};
        sample.point = (x[corner[0]] + x[corner[1]] + x[corner[2]]) / 3.0;
    } else {
        const auto [a, b] = cloths_.edges.vertex[edge];
        sample.vertex = {a, b, -1};
        sample.point = 0.5 * (x[a] + x[b]);
    }
    return sample;
}

/// Samples whose signed distance from a body is below bound(sample) [m].
template <typename Bound>
std::vector<InsideSample> BodyClearing::samples_below(View<const Vec3> x, const Bound& bound) const
{
    const int count = x.size() + int(cloths_.triangles.size()) + cloths_.edges.edge_count();
    std::vector<InsideSample> found;
    const auto find = [&](int begin, int end, std::vector<InsideSample>& out) {
        for (int i = begin; i < end; ++i) {
            InsideSample sample = sample_at(x, i);
            const double limit = bound(sample);
            if (!std::isfinite(limit) || !sample.point.allFinite())
                continue;
            const auto proximity = nearest_body(bodies_, sample.point, std::max(limit, 0.0));
            if (!proximity || proximity->signed_distance >= limit)
                continue;
            sample.proximity = *proximity;
            out.push_back(sample);
        }
    };
    parallel_append(kCpu, "untangle/body_samples", count, find, found);
    return found;
}

void BodyClearing::grow(View<Vec3> x, const ShapeKeeper& keeper, const RepairProgress& progress) const
{
    double deepest = 0.0;
    for (const InsideSample& sample : movable_below(x, 0.0))
        deepest = std::max(deepest, -sample.proximity.signed_distance);
    const int increments = std::clamp(int(std::ceil(deepest / kIncrement)), 1, kMaxIncrements);
    for (int k = 0; k < increments; ++k) {
        const std::vector<InsideSample> samples = movable_below(x, 0.0);
        if (samples.empty())
            return;
        displace(x, samples, 1.0 / (increments - k));
        keeper.relax(x, kSweeps);
        progress.update(double(k + 1) / increments);
    }
    project(x);
}

/// Moves every vertex near the samples by `fraction` of the displacement that takes the local depth D out to
/// the gap g. Distances from -D to the top G of the band map linearly, in order, to those from g to G.
void BodyClearing::displace(View<Vec3> x, const std::vector<InsideSample>& inside, double fraction) const
{
    double deepest = 0.0;
    for (const InsideSample& sample : inside)
        deepest = std::max(deepest, -sample.proximity.signed_distance);
    const std::vector<Vec3> before(x.begin(), x.end());
    parallel_for(
        kCpu, "untangle/displace", x.size(),
        [&](int v) {
            if (cloths_.fixed[v] != 0)
                return;
            const double g = cloths_.gap[v];
            const auto proximity = nearest_body(bodies_, before[v], g + kBand * (g + deepest));
            if (!proximity)
                return;
            double lift = 0.0; // D + g
            for (const InsideSample& sample : inside) {
                const double depth = g - sample.proximity.signed_distance;
                const double away = (sample.point - before[v]).norm() / (kReach * depth);
                if (sample.proximity.body == proximity->body && away < 1.0)
                    lift = std::max(lift, depth * std::min(1.0, 2.0 * (1.0 - away)));
            }
            const double top = g + kBand * lift;
            if (lift == 0.0 || proximity->signed_distance >= top)
                return;
            const double scale = kBand / (1.0 + kBand);
            const double target =
                std::max(top - (top - proximity->signed_distance) * scale, proximity->signed_distance);
            x[v] += fraction * (target - proximity->signed_distance) * proximity->normal;
        },
        16);
}

void BodyClearing::project(View<Vec3> x) const
{
    std::vector<Vec3> move(x.size(), Vec3::Zero());
    for (const InsideSample& sample : movable_below(x, 1.0)) {
        const double depth = cloths_.gap[sample.vertex[0]] - sample.proximity.signed_distance;
        add_move(sample.vertex, depth, sample.proximity.normal, cloths_.fixed, move);
    }
    for (int v = 0; v < x.size(); ++v)
        x[v] += move[v];
}

void BodyClearing::project_off_tips(View<Vec3> x) const
{
    std::vector<Vec3> move(x.size(), Vec3::Zero());
    const SurfaceProximity cloth(cloths_.triangles, x);
    const Bounds box = bounds(x);
    for (const ContactCollider& body : bodies_) {
        if (body.mesh == nullptr)
            continue;
        const SurfaceProximity& surface = body.mesh->surface();
        std::vector<std::pair<int, Vec3>> lifts(surface.positions().size(), {-1, Vec3::Zero()});
        parallel_for(kCpu, "untangle/tips", int(lifts.size()), [&](int v) {
            const Vec3& q = surface.positions()[v];
            if ((q.array() < box.lower.array()).any() || (q.array() > box.upper.array()).any())
                return;
            const std::optional<SurfacePoint> at = cloth.closest(q, kMaxTip);
            if (!at)
                return;
            const Vec3 normal = surface.vertex_normal(v);
            const double height = normal.dot(q - at->point);
            if (height > kTipGap - kMaxTip && height > 0.7 * at->distance() - kTipGap)
                lifts[v] = {at->triangle, (height + kTipGap) * normal};
        });
        for (const auto& [triangle, lift] : lifts)
            if (triangle >= 0)
                add_move(corners_of(triangle), lift.norm(), lift.normalized(), cloths_.fixed, move);
    }
    for (int v = 0; v < x.size(); ++v)
        x[v] += move[v];
}

std::array<int, 3> BodyClearing::corners_of(int triangle) const
{
    const Triangle& t = cloths_.triangles[triangle];
    return {t[0], t[1], t[2]};
}

std::vector<SurfaceCrossing> BodyClearing::crossings(View<const Vec3> x, Which which) const
{
    std::vector<int> numbers;
    std::vector<Triangle> triangles;
    for (int t = 0; t < int(cloths_.triangles.size()); ++t)
        if (which == Which::All || can_move(corners_of(t))) {
            numbers.push_back(t);
            triangles.push_back(cloths_.triangles[t]);
        }
    std::vector<SurfaceCrossing> found;
    for (const Crossing& crossing : find_crossings(triangles, x, surface_triangles_, surface_x_)) {
        if (is_buried(crossing.b, crossing.point))
            continue;
        std::array<Vec3, 3> cloth, body;
        for (int k = 0; k < 3; ++k) {
            cloth[k] = x[triangles[crossing.a][k]];
            body[k] = surface_x_[surface_triangles_[crossing.b][k]];
        }
        found.push_back({numbers[crossing.a], body_of_[crossing.b], crossing.point, way_off(cloth, body)});
    }
    return found;
}

bool BodyClearing::push_off_crossings(View<Vec3> x, std::vector<double>& pushed) const
{
    std::vector<Vec3> move(x.size(), Vec3::Zero());
    bool has_moved = false;
    for (const SurfaceCrossing& crossing : crossings(x, Which::Movable))
        add_move(corners_of(crossing.triangle), crossing.way_out.norm(), crossing.way_out.normalized(),
                 cloths_.fixed, move);
    for (int v = 0; v < x.size(); ++v) {
        const double length = std::min(move[v].norm(), kMaxPush);
        if (length == 0.0 || pushed[v] + length > kMaxPushed)
            continue;
        pushed[v] += length;
        x[v] += length * move[v].normalized();
        has_moved = true;
    }
    return has_moved;
}

} // namespace toile::collision
