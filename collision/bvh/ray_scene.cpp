#include "collision/bvh/ray_scene.h"

#include <algorithm>
#include <limits>
#include <vector>

#include <Eigen/Geometry>
#include <embree3/rtcore.h>

#include "collision/bvh/embree_device.h"

namespace toile::collision {

namespace {

/// Directions of the rays that determine the winding number: unit to 1e-3, no component rational to another,
/// 80 to 100 degrees apart. Rays then do not hit axis-aligned and symmetric meshes along their edges.
constexpr double kDirections[3][3] = {{0.6180340, 0.7205759, 0.3141593},
                                      {-0.7071825, 0.2718282, 0.6526912},
                                      {0.2360680, -0.6931472, 0.6810452}};

RTCRay make_ray(const Vec3& origin, const Vec3& direction, double t_max)
{
    RTCRay ray{};
    ray.org_x = float(origin.x());
    ray.org_y = float(origin.y());
    ray.org_z = float(origin.z());
    ray.dir_x = float(direction.x());
    ray.dir_y = float(direction.y());
    ray.dir_z = float(direction.z());
    ray.tnear = 0.0f;
    ray.tfar = float(t_max);
    ray.mask = 0xffffffffu;
    return ray;
}

/// Context of a ray that counts the surfaces it crosses instead of stopping. Embree passes the filter a
/// pointer to the first member.
struct CrossingCount {
    RTCIntersectContext context;
    int exits_minus_entries = 0, hits = 0;
};

/// Counts the hit by the side it comes from and rejects it, so that the traversal continues behind it.
void count_crossing(const RTCFilterFunctionNArguments* arguments)
{
    TOILE_ASSERT(arguments->N == 1);
    auto* count = reinterpret_cast<CrossingCount*>(arguments->context);
    const auto* ray = reinterpret_cast<const RTCRay*>(arguments->ray);
    const auto* hit = reinterpret_cast<const RTCHit*>(arguments->hit);
    const float along = ray->dir_x * hit->Ng_x + ray->dir_y * hit->Ng_y + ray->dir_z * hit->Ng_z;
    count->exits_minus_entries += along > 0.0f ? 1 : -1;
    ++count->hits;
    arguments->valid[0] = 0;
}

} // namespace

/// Embree data: one scene, one geometry per mesh.
struct RayScene::Trees {
    RTCScene scene = nullptr;
    std::vector<RTCGeometry> geometries; ///< borrowed: the scene owns them
    std::vector<float*> vertices;        ///< [meshes] Embree's own copy, 3 floats a vertex

    Trees() : scene(rtcNewScene(embree_device()))
    {
        // Low build quality selects the two-level tree, the only one that refits a mesh in place.
        rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_LOW);
        rtcSetSceneFlags(scene, RTCSceneFlags(RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST |
                                              RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
    }
    ~Trees() { rtcReleaseScene(scene); }
    Trees(const Trees&) = delete;
    Trees& operator=(const Trees&) = delete;

    void write(int mesh, View<const Vec3> positions)
    {
        float* out = vertices[mesh];
        for (const Vec3& x : positions)
            for (int k = 0; k < 3; ++k)
                *out++ = float(x[k]);
    }

    /// Crossings along an unbounded ray.
    CrossingCount count_crossings(const Vec3& origin, const Vec3& direction) const
    {
        CrossingCount count;
        rtcInitIntersectContext(&count.context);
        count.context.filter = count_crossing;
        RTCRayHit ray_hit{make_ray(origin, direction, std::numeric_limits<double>::infinity()), {}};
        ray_hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene, &count.context, &ray_hit);
        return count;
    }
};

RayScene::RayScene() : trees_(std::make_unique<Trees>()) {}
RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

int RayScene::add(View<const Vec3> positions, View<const Triangle> triangles)
{
    const RTCGeometry geometry = rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_REFIT);
    trees_->vertices.push_back(
        static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                    3 * sizeof(float), size_t(positions.size()))));
    auto* indices =
        static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                       3 * sizeof(unsigned), size_t(triangles.size())));
    require_embree_success();
    for (const Triangle& corner : triangles)
        for (const int v : corner)
            *indices++ = unsigned(v);

    const int mesh = int(rtcAttachGeometry(trees_->scene, geometry));
    TOILE_ASSERT(mesh == int(trees_->geometries.size()));
    trees_->geometries.push_back(geometry);
    trees_->write(mesh, positions);
    rtcCommitGeometry(geometry);
    rtcReleaseGeometry(geometry);
    return mesh;
}

void RayScene::update(int mesh, View<const Vec3> positions)
{
    const RTCGeometry geometry = trees_->geometries[mesh];
    trees_->write(mesh, positions);
    rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(geometry);
}

void RayScene::commit()
{
    rtcCommitScene(trees_->scene);
    require_embree_success();
}

std::optional<RayHit> RayScene::closest_hit(const Vec3& origin, const Vec3& direction, double t_max) const
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray_hit{make_ray(origin, direction, t_max), {}};
    ray_hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(trees_->scene, &context, &ray_hit);
    if (ray_hit.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return std::nullopt;
    return RayHit{int(ray_hit.hit.geomID), int(ray_hit.hit.primID), double(ray_hit.hit.u),
                  double(ray_hit.hit.v), double(ray_hit.ray.tfar)};
}

bool RayScene::occluded(const Vec3& origin, const Vec3& direction, double t_max) const
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = make_ray(origin, direction, t_max);
    rtcOccluded1(trees_->scene, &context, &ray);
    return ray.tfar < 0.0f;
}

int RayScene::hit_count(const Vec3& origin, const Vec3& direction) const
{
    return trees_->count_crossings(origin, direction).hits;
}

int RayScene::winding_number(const Vec3& point) const
{
    const auto count = [&](int k) {
        return trees_->count_crossings(point, Vec3(kDirections[k][0], kDirections[k][1], kDirections[k][2]))
            .exits_minus_entries;
    };
    const int first = count(0);
    const int second = count(1);
    if (first == second)
        return first;
    const int third = count(2);
    return second == third ? second : third == first ? first : std::min({first, second, third});
}

} // namespace toile::collision
