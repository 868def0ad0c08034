#include "research/benchmarks/near_pairs/by_collide.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>

#include <embree3/rtcore.h>

#include "collision/bvh/embree_device.h"
#include "collision/geometry/distance.h"

namespace toile::research::near_pairs {

namespace {

float below(double value) { return std::nextafter(float(value), -std::numeric_limits<float>::infinity()); }
float above(double value) { return std::nextafter(float(value), std::numeric_limits<float>::infinity()); }

/// True if the boxes around two segments are farther apart than `margin` [m] along some axis.
bool are_apart(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1, double margin)
{
    const Vec3 gap = (a0.cwiseMin(a1) - b0.cwiseMax(b1)).cwiseMax(b0.cwiseMin(b1) - a0.cwiseMax(a1));
    return gap.maxCoeff() > margin;
}

} // namespace

/// Embree scene of the triangles' grown boxes.
class ByCollide::Scene {
public:
    explicit Scene(unsigned triangle_count)
        : boxes_(triangle_count), scene_(rtcNewScene(collision::embree_device())),
          geometry_(rtcNewGeometry(collision::embree_device(), RTC_GEOMETRY_TYPE_USER))
    {
        // Low build quality selects the two-level tree, the only one that refits a geometry in place.
        rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC);
        rtcSetGeometryBuildQuality(geometry_, RTC_BUILD_QUALITY_REFIT);
        rtcSetGeometryUserPrimitiveCount(geometry_, triangle_count);
        rtcSetGeometryUserData(geometry_, this);
        rtcSetGeometryBoundsFunction(
            geometry_,
            [](const RTCBoundsFunctionArguments* arguments) {
                const auto& self = *static_cast<const Scene*>(arguments->geometryUserPtr);
                *arguments->bounds_o = self.boxes_[arguments->primID];
            },
            nullptr);
        rtcAttachGeometry(scene_, geometry_);
        rtcReleaseGeometry(geometry_);
    }
    ~Scene() { rtcReleaseScene(scene_); }
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    /// Updates boxes so that they overlap if triangles are at most `margin` [m] apart along every axis.
    void move(View<const Triangle> triangles, View<const Vec3> x, double margin)
    {
        for (int t = 0; t < triangles.size(); ++t) {
            const Vec3 &a = x[triangles[t][0]], &b = x[triangles[t][1]], &c = x[triangles[t][2]];
            const Vec3 lower = a.cwiseMin(b).cwiseMin(c).array() - 0.5 * margin;
            const Vec3 upper = a.cwiseMax(b).cwiseMax(c).array() + 0.5 * margin;
            boxes_[size_t(t)] = {below(lower.x()), below(lower.y()), below(lower.z()), 0.0f,
                                 above(upper.x()), above(upper.y()), above(upper.z()), 0.0f};
        }
        rtcCommitGeometry(geometry_);
        rtcCommitScene(scene_);
    }

    /// True if two boxes overlap. Leaves of the tree hold several triangles, and Embree proposes all pairs of
    /// two leaves.
    bool do_meet(unsigned s, unsigned t) const
    {
        const RTCBounds &a = boxes_[s], &b = boxes_[t];
        return a.lower_x <= b.upper_x && b.lower_x <= a.upper_x && a.lower_y <= b.upper_y &&
               b.lower_y <= a.upper_y && a.lower_z <= b.upper_z && b.lower_z <= a.upper_z;
    }

    void collide(RTCCollideFunc callback, void* user) const { rtcCollide(scene_, scene_, callback, user); }

private:
    std::vector<RTCBounds> boxes_; ///< [triangles]
    RTCScene scene_;
    RTCGeometry geometry_; ///< borrowed: the scene owns it
};

/// State of a search; Embree calls back from several threads at once.
struct ByCollide::Search {
    const ByCollide& self;
    double margin;
    std::vector<Found>& found;
    std::mutex mutex{};
};

ByCollide::ByCollide(View<const Triangle> triangles, View<const Vec3> positions)
    : triangles_(triangles.begin(), triangles.end()),
      edges_(collision::build_surface_edges(triangles, positions.size())),
      x_(positions.begin(), positions.end()), scene_(std::make_unique<Scene>(unsigned(triangles.size())))
{
    scene_->move(triangles_, x_, 0.0);
}
ByCollide::~ByCollide() = default;

/// Vertices of triangle s near triangle t.
void ByCollide::find_vertices(int s, int t, double margin, std::vector<Found>& out) const
{
    const Triangle& c = triangles_[t];
    for (const int v : triangles_[s]) {
        if (!is_own_vertex(v, s) || c[0] == v || c[1] == v || c[2] == v)
            continue;
        if (collision::closest_on_triangle(x_[v], x_[c[0]], x_[c[1]], x_[c[2]]).distance2 <= margin * margin)
            out.push_back({v, t});
    }
}

void ByCollide::find_edges(int s, int t, double margin, std::vector<Found>& out) const
{
    for (const int e : edges_.triangle_edge[s])
        for (const int f : edges_.triangle_edge[t]) {
            const auto &a = edges_.vertex[e], &b = edges_.vertex[f];
            if (!is_own_edge(e, s) || !is_own_edge(f, t) || a[0] == b[0] || a[0] == b[1] || a[1] == b[0] ||
                a[1] == b[1] || are_apart(x_[a[0]], x_[a[1]], x_[b[0]], x_[b[1]], margin))
                continue;
            if (collision::closest_on_segments(x_[a[0]], x_[a[1]], x_[b[0]], x_[b[1]]).distance2 <=
                margin * margin)
                out.push_back({std::min(e, f), std::max(e, f)});
        }
}

void ByCollide::find_between(int s, int t, double margin, std::vector<Found>& out) const
{
    find_vertices(s, t, margin, out);
    find_vertices(t, s, margin, out);
    find_edges(s, t, margin, out);
}

size_t ByCollide::find(View<const Vec3> x, double margin)
{
    x_.assign(x.begin(), x.end());
    scene_->move(triangles_, x_, margin);
    found_.clear();
    Search search{*this, margin, found_};
    scene_->collide(
        [](void* user, RTCCollision* collisions, unsigned count) {
            auto& [self, reach, found, mutex] = *static_cast<Search*>(user);
            thread_local std::vector<Found> near;
            near.clear();
            // Embree proposes every pair of triangles from both sides.
            for (unsigned k = 0; k < count; ++k) {
                const unsigned s = collisions[k].primID0, t = collisions[k].primID1;
                if (s < t && self.scene_->do_meet(s, t))
                    self.find_between(int(s), int(t), reach, near);
            }
            const std::lock_guard lock(mutex);
            found.insert(found.end(), near.begin(), near.end());
        },
        &search);
    return found_.size();
}

size_t ByCollide::find_candidates(View<const Vec3> x, double margin)
{
    scene_->move(triangles_, x, margin);
    std::atomic<size_t> candidates = 0;
    scene_->collide(
        [](void* user, RTCCollision*, unsigned count) { *static_cast<std::atomic<size_t>*>(user) += count; },
        &candidates);
    return candidates;
}

} // namespace toile::research::near_pairs
