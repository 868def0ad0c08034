#include "collision/repair/body_clearing.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

} // namespace

BodyClearing::BodyClearing(const JoinedCloths& cloths, std::vector<ContactCollider> bodies)
    : cloths_(cloths), bodies_(std::move(bodies))
{
}

std::vector<InsideSample> BodyClearing::inside(View<const Vec3> x, double depth) const
{
    return samples_below(x, [&](const InsideSample&) { return -depth; });
}

std::vector<InsideSample> BodyClearing::movable_below(View<const Vec3> x, Limit limit) const
{
    return samples_below(x, [&](const InsideSample& sample) {
        if (!can_move(sample))
            return -std::numeric_limits<double>::infinity();
        return limit == Limit::Gap ? cloths_.gap[sample.vertex[0]] : 0.0;
    });
}

bool BodyClearing::can_move(const InsideSample& sample) const
{
    return std::any_of(sample.vertex.begin(), sample.vertex.end(),
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

int BodyClearing::grow(View<Vec3> x, const ShapeKeeper& keeper) const
{
    double deepest = 0.0;
    for (const InsideSample& sample : movable_below(x, Limit::Surface))
        deepest = std::max(deepest, -sample.proximity.signed_distance);
    const int increments = std::clamp(int(std::ceil(deepest / kIncrement)), 1, kMaxIncrements);
    for (int k = 0; k < increments; ++k) {
        const std::vector<InsideSample> samples = movable_below(x, Limit::Surface);
        if (samples.empty())
            return k;
        displace(x, samples, 1.0 / (increments - k));
        keeper.relax(x, kSweeps);
    }
    project(x);
    return increments;
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
    for (const InsideSample& sample : movable_below(x, Limit::Gap)) {
        const double depth = cloths_.gap[sample.vertex[0]] - sample.proximity.signed_distance;
        for (const int v : sample.vertex)
            if (v >= 0 && cloths_.fixed[v] == 0) {
                // Of several samples the most demanding one decides along each direction.
                const double served = move[v].dot(sample.proximity.normal);
                if (served < depth)
                    move[v] += (depth - served) * sample.proximity.normal;
            }
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
            for (int k = 0; triangle >= 0 && k < 3; ++k) {
                const int v = cloths_.triangles[triangle][k];
                const double wanted = lift.norm(), served = wanted > 0.0 ? move[v].dot(lift) / wanted : 0.0;
                if (cloths_.fixed[v] == 0 && served < wanted)
                    move[v] += (wanted - served) / wanted * lift;
            }
    }
    for (int v = 0; v < x.size(); ++v)
        x[v] += move[v];
}

} // namespace toile::collision
