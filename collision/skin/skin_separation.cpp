#include "collision/skin/skin_separation.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <queue>

#include "collision/bvh/cell_grid.h"
#include "collision/check/find_crossings.h"
#include "core/base/stages.h"
#include "core/compute/parallel.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::collision {

namespace {

/// Rings over which directions into the body are averaged.
constexpr int kRings = 2;
/// Part of a limb's thickness that its skin may move in.
constexpr double kMaxShare = 0.3;
/// Distance [m] from a vertex at which its rays begin, beyond its own triangles.
constexpr double kRayStart = 1e-4;
/// Thickness [m] of what is not measured, and at least.
constexpr double kMaxThickness = 0.2;
/// Insets [m] below this make no difference.
constexpr double kTolerance = 1e-4;
/// Inset [m] that a crossing triangle gains in a pass.
constexpr double kCrossingInset = 1e-3;
constexpr int kRoomPasses = 6;
/// Surfaces that a ray inwards goes through.
constexpr int kLayers = 4;
/// Passes after which crossings that have not become fewer are left as they are.
constexpr int kVainPasses = 3;
/// Cosine above which two surfaces don't face each other.
constexpr double kFacing = -0.2;
/// Size [m] of the cells around skin near other skin in which crossings are looked for.
constexpr double kCell = 0.02;
/// Distance at rest [m] beyond twice the depth of an overlap: nearer skin is the far side of a limb.
constexpr double kClose = 0.01;
/// Part of its distance at rest that skin keeps where that is less than the clearance.
constexpr double kRestShare = 0.9;

std::vector<std::vector<int>> neighbours_of(View<const Triangle> triangles, int vertex_count)
{
    std::vector<std::vector<int>> neighbours(static_cast<size_t>(vertex_count));
    for (const Triangle& corner : triangles)
        for (int k = 0; k < 3; ++k) {
            neighbours[corner[k]].push_back(corner[(k + 1) % 3]);
            neighbours[corner[k]].push_back(corner[(k + 2) % 3]);
        }
    for (std::vector<int>& of_vertex : neighbours) {
        std::sort(of_vertex.begin(), of_vertex.end());
        of_vertex.erase(std::unique(of_vertex.begin(), of_vertex.end()), of_vertex.end());
    }
    return neighbours;
}

std::vector<Vec3> smoothed(std::vector<Vec3> directions, const std::vector<std::vector<int>>& neighbours)
{
    for (int ring = 0; ring < kRings; ++ring) {
        const std::vector<Vec3> before = directions;
        for (size_t v = 0; v < directions.size(); ++v) {
            for (const int u : neighbours[v])
                directions[v] += before[u];
            directions[v].stableNormalize();
        }
    }
    return directions;
}

} // namespace

/// A pose while its insets grow.
struct SkinSeparation::Pose {
    View<const Vec3> x;
    View<const Vec3> inward;
    std::vector<double> inset;             ///< [vertices] [m]
    std::vector<Vec3> moved;               ///< [vertices] x, inset [m]
    std::vector<unsigned char> faces_skin; ///< [vertices] 1: other skin is nearer than at rest
};

/// Skin that a vertex faces, or has entered.
struct SkinSeparation::Facing {
    bool is_near = false; ///< nearer than at rest
    double lacking = 0.0; ///< half the room that lacks in between [m]
    int triangle = -1;    ///< of the other skin
};

SkinSeparation::SkinSeparation(std::vector<Triangle> triangles, std::vector<Vec3> rest, double clearance)
    : triangles_(std::move(triangles)), rest_(std::move(rest)), clearance_(clearance),
      neighbours_(neighbours_of(triangles_, int(rest_.size())))
{
    std::vector<Vec3> inwards = vertex_normals(rest_, triangles_);
    for (Vec3& direction : inwards)
        direction = -direction;
    inward_ = smoothed(inwards, neighbours_);

    // Measure how thick the limb is along each direction.
    rays_.add(rest_, triangles_);
    rays_.commit();
    const auto thickness = [&](int v, const Vec3& direction) {
        const auto hit = rays_.closest_hit(rest_[v] + kRayStart * direction, direction, kMaxThickness);
        return hit ? hit->t : kMaxThickness;
    };
    max_inset_.resize(rest_.size());
    parallel_for(kCpu, "collision/skin_thickness", int(rest_.size()), [&](int v) {
        if (!inward_[v].isZero() && !inwards[v].isZero())
            max_inset_[v] =
                std::min(kMaxInset, kMaxShare * std::min(thickness(v, inward_[v]), thickness(v, inwards[v])));
    });
}

std::vector<double> SkinSeparation::insets(View<const Vec3> x, View<const Vec3> inward)
{
    const StageScope stage("collision/skin_separation");
    Pose pose{x,
              inward,
              std::vector<double>(rest_.size()),
              {x.begin(), x.end()},
              std::vector<unsigned char>(rest_.size(), 0)};
    make_room(pose);
    uncross(pose);
    return std::move(pose.inset);
}

/// Both sides of what lacks room give way: fine skin, such as a finger's, may find coarse skin that does not
/// find it. Insets only shrink what lacks room, so each pass looks at vertices that lacked some in the last.
void SkinSeparation::make_room(Pose& pose)
{
    std::vector<int> watched(rest_.size());
    std::iota(watched.begin(), watched.end(), 0);
    std::vector<Facing> facing(rest_.size());
    for (int pass = 0; pass < kRoomPasses && !watched.empty(); ++pass) {
        rays_.update(0, pose.moved);
        rays_.commit();
        const std::vector<Vec3> normals = vertex_normals(pose.moved, triangles_);
        parallel_for(kCpu, "collision/skin_room", int(watched.size()),
                     [&](int i) { facing[watched[i]] = facing_at(pose, watched[i], normals[watched[i]]); });

        std::vector<double> wanted(rest_.size());
        const auto want = [&](int v, double lacking) {
            wanted[v] = std::max(wanted[v], pose.inset[v] + lacking);
        };
        for (const int v : watched) {
            if (facing[v].is_near)
                pose.faces_skin[v] = 1;
            if (facing[v].lacking <= kTolerance)
                continue;
            want(v, facing[v].lacking);
            for (const int corner : triangles_[facing[v].triangle])
                want(corner, facing[v].lacking);
        }
        std::erase_if(watched, [&](int v) { return facing[v].lacking <= kTolerance; });
        if (!raise(pose, wanted))
            return;
    }
}

SkinSeparation::Facing SkinSeparation::facing_at(const Pose& pose, int v, const Vec3& normal) const
{
    if (normal.isZero() || max_inset_[v] == 0.0)
        return {};
    const Facing before = in_front(pose, v, normal), behind = this->behind(pose, v, normal);
    const Facing& worse = behind.lacking > before.lacking ? behind : before;
    return {before.is_near || behind.is_near, worse.lacking, worse.triangle};
}

SkinSeparation::Facing SkinSeparation::in_front(const Pose& pose, int v, const Vec3& normal) const
{
    const auto hit = rays_.closest_hit(pose.moved[v] + kRayStart * normal, normal, clearance_);
    return hit ? beside(pose, v, normal, *hit, hit->t) : Facing{};
}

/// The deepest skin out of which a ray inwards comes: that of a limb that has entered, or lies inside.
SkinSeparation::Facing SkinSeparation::behind(const Pose& pose, int v, const Vec3& normal) const
{
    Facing deepest;
    double depth = 0.0;
    for (int layer = 0; layer < kLayers; ++layer) {
        const double start = depth + kRayStart;
        const auto hit = rays_.closest_hit(pose.moved[v] - start * normal, -normal, 2.0 * kMaxInset - start);
        if (!hit)
            break;
        depth = start + hit->t;
        const Facing facing = beside(pose, v, normal, *hit, -depth);
        if (facing.lacking > deepest.lacking)
            deepest = facing;
    }
    return deepest;
}

/// @param distance  [m] in front of the vertex; negative: behind it
SkinSeparation::Facing SkinSeparation::beside(const Pose& pose, int v, const Vec3& normal, const RayHit& hit,
                                              double distance) const
{
    const Triangle& corner = triangles_[hit.triangle];
    const auto at = [&](const auto& positions) -> Vec3 {
        return (1.0 - hit.u - hit.v) * positions[corner[0]] + hit.u * positions[corner[1]] +
               hit.v * positions[corner[2]];
    };
    const Vec3 other_normal = (pose.moved[corner[1]] - pose.moved[corner[0]])
                                  .cross(pose.moved[corner[2]] - pose.moved[corner[0]])
                                  .stableNormalized();
    if (other_normal.dot(normal) > kFacing)
        return {};

    // The far side of the same limb is as far away at rest. Skin that is near at rest needs no more room.
    const double rest_distance = (at(rest_) - rest_[v]).norm();
    if (distance < 0.0 && rest_distance < kClose - 2.0 * distance)
        return {};
    const double kept = kRestShare * rest_distance;
    return {distance < kept, 0.5 * (std::min(clearance_, kept) - distance), hit.triangle};
}

/// Skin that crosses gives way a little at a time, until none crosses or all has given what it can.
void SkinSeparation::uncross(Pose& pose)
{
    size_t fewest = std::numeric_limits<size_t>::max();
    for (int pass = 0, pass_of_fewest = 0; pass - pass_of_fewest < kVainPasses; ++pass) {
        const std::vector<Triangle> near = triangles_near(pose);
        const std::vector<Crossing> crossings = find_crossings(near, pose.moved);
        if (crossings.size() < fewest) {
            fewest = crossings.size();
            pass_of_fewest = pass;
        }
        std::vector<double> wanted(rest_.size());
        for (const Crossing& crossing : crossings)
            for (const int t : {crossing.a, crossing.b})
                for (const int v : near[t])
                    wanted[v] = pose.inset[v] + kCrossingInset;
        if (!raise(pose, wanted))
            return;
    }
}

/// Triangles beside vertices that face other skin, or that have an inset: others cross nothing.
std::vector<Triangle> SkinSeparation::triangles_near(const Pose& pose) const
{
    // Mark the cells around these vertices.
    const CellGrid grid(bounds(pose.moved), kCell);
    std::vector<unsigned char> is_near(static_cast<size_t>(grid.cell_count()), 0);
    for (size_t v = 0; v < pose.moved.size(); ++v)
        if (pose.inset[v] > 0.0 || pose.faces_skin[v] != 0) {
            const CellGrid::Cell cell = grid.cell_of(pose.moved[v]);
            grid.for_cells({cell[0] - 1, cell[1] - 1, cell[2] - 1}, {cell[0] + 1, cell[1] + 1, cell[2] + 1},
                           [&](int number) { is_near[number] = 1; });
        }

    std::vector<Triangle> near;
    for (const Triangle& corners : triangles_)
        if (std::any_of(corners.begin(), corners.end(),
                        [&](int v) { return is_near[grid.number_of(grid.cell_of(pose.moved[v]))] != 0; }))
            near.push_back(corners);
    return near;
}

/// Raises insets to those wanted, as far as limbs are thick, and with them those around.
/// @return false if nothing could be raised
bool SkinSeparation::raise(Pose& pose, const std::vector<double>& wanted) const
{
    using Raised = std::pair<double, int>;
    std::priority_queue<Raised> queue;
    const auto raise_to = [&](int v, double inset) {
        inset = std::min(inset, max_inset_[v]);
        if (inset <= pose.inset[v] + kTolerance)
            return;
        pose.inset[v] = inset;
        queue.push({inset, v});
    };
    for (size_t v = 0; v < wanted.size(); ++v)
        raise_to(int(v), wanted[v]);
    const bool is_raised = !queue.empty();
    while (!queue.empty()) {
        const auto [inset, v] = queue.top();
        queue.pop();
        if (inset == pose.inset[v])
            for (const int u : neighbours_[v])
                raise_to(u, inset - kSlope * (rest_[u] - rest_[v]).norm());
    }
    for (size_t v = 0; v < pose.moved.size(); ++v)
        pose.moved[v] = pose.x[v] + pose.inset[v] * pose.inward[v];
    return is_raised;
}

} // namespace toile::collision
