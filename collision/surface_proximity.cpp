#include "collision/surface_proximity.h"

#include <algorithm>
#include <utility>

#include <embree3/rtcore.h>

#include "collision/embree_device.h"
#include "core/backend/parallel.h"

namespace toile {

namespace {

/// Two closest points nearer than this [m] are the same one, reached through neighbouring triangles.
constexpr double kSamePoint = 1e-9;

/// Single-precision slack of Embree's boxes and query points, relative to the largest coordinate and to the
/// radius [-]: several times the rounding of both (2^-24), so that no triangle is ever missed.
constexpr double kFloatSlack = 1e-6;

struct NearTriangle {
    int triangle;
    ClosestOnTriangle closest;
};

Vec3 unit_or_zero(const Vec3& v)
{
    const double length = v.norm();
    return length > 1e-12 ? Vec3(v / length) : Vec3(Vec3::Zero());
}

} // namespace

/// Own arrays in double beside Embree's in float.
class SurfaceProximity::Surface {
public:
    Surface(View<const Triangle> triangles, int vertex_count);
    ~Surface() { rtcReleaseScene(scene_); }
    Surface(const Surface&) = delete;
    Surface& operator=(const Surface&) = delete;

    void move(View<const Vec3> positions);

    ClosestOnTriangle closest_on(int t, const Vec3& p) const
    {
        return closest_on_triangle(p, corners_[3 * t], corners_[3 * t + 1], corners_[3 * t + 2]);
    }
    /// Cheap and safe: true only when triangle t is farther from p than `radius`, by its bounding sphere.
    bool is_farther(int t, const Vec3& p, double radius) const
    {
        const double reach = radius + spheres_[t].radius;
        return (p - spheres_[t].center).squaredNorm() > reach * reach;
    }
    // Computed when asked for: a refit touches every feature, the queries that follow touch few.
    Vec3 edge_normal(int e) const;
    Vec3 vertex_normal(int v) const;

    SurfacePoint surface_point(const NearTriangle& near, const Vec3& p) const;
    bool is_local_minimum(const NearTriangle& near, const Vec3& p) const;

    /// Radius for Embree that covers every triangle within `radius` of p in exact arithmetic.
    float padded(double radius, const Vec3& p) const
    {
        return float(radius + kFloatSlack * (radius + largest_coordinate_ + p.cwiseAbs().maxCoeff()));
    }

    /// Calls visit(triangle) for every triangle within `radius` of p and some more, in any order. visit
    /// returns a smaller radius, or a negative number to keep the current one.
    template <typename Visit>
    void visit(const Vec3& p, double radius, const Visit& visit) const;

    std::vector<Triangle> triangles;
    std::vector<Vec3> positions;
    SurfaceEdges edges;
    std::vector<Vec3> face_normals; ///< [triangles] unit or zero

private:
    struct Sphere {
        Vec3 center;
        double radius;
    };

    void compute_faces();

    RTCScene scene_ = nullptr;
    RTCGeometry geometry_ = nullptr; ///< borrowed: the scene owns it
    float* vertices_ = nullptr;      ///< Embree's copy, 3 floats a vertex
    std::vector<Vec3> corners_;      ///< [3 triangles] corner positions side by side, for the cache
    std::vector<Sphere> spheres_;    ///< [triangles] around the corners, slightly too large
    double largest_coordinate_ = 0.0;
};

SurfaceProximity::Surface::Surface(View<const Triangle> triangle_list, int vertex_count)
    : triangles(triangle_list.begin(), triangle_list.end()),
      edges(build_surface_edges(triangle_list, vertex_count)), face_normals(triangles.size()),
      scene_(rtcNewScene(embree_device())), corners_(3 * triangles.size()), spheres_(triangles.size())
{
    // Low build quality selects the two-level tree, the only one that refits a mesh in place.
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);
    rtcSetSceneFlags(scene_, RTCSceneFlags(RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST));
    geometry_ = rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry_, RTC_BUILD_QUALITY_REFIT);
    vertices_ = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry_, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), size_t(vertex_count)));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry_, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), triangles.size()));
    for (const Triangle& corner : triangles)
        for (const int v : corner)
            *indices++ = unsigned(v);
    rtcAttachGeometry(scene_, geometry_);
    rtcReleaseGeometry(geometry_);
}

void SurfaceProximity::Surface::move(View<const Vec3> new_positions)
{
    positions.assign(new_positions.begin(), new_positions.end());
    largest_coordinate_ = 0.0;
    float* out = vertices_;
    for (const Vec3& x : positions) {
        largest_coordinate_ = std::max(largest_coordinate_, x.cwiseAbs().maxCoeff());
        for (int k = 0; k < 3; ++k)
            *out++ = float(x[k]);
    }
    compute_faces();
    rtcUpdateGeometryBuffer(geometry_, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(geometry_);
    rtcCommitScene(scene_);
}

void SurfaceProximity::Surface::compute_faces()
{
    constexpr double kSphereSlack = 1e-9; // [-] rounding must not shrink a sphere
    parallel_for(kCpu, "collision/faces", int(triangles.size()), [this](int t) {
        Vec3* corner = &corners_[3 * t];
        for (int k = 0; k < 3; ++k)
            corner[k] = positions[triangles[t][k]];
        const Vec3 doubled_area = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
        const double length = doubled_area.norm();
        face_normals[t] = length > 0.0 ? Vec3(doubled_area / length) : Vec3(Vec3::Zero());

        const Vec3 center = (corner[0] + corner[1] + corner[2]) / 3.0;
        const double radius2 =
            std::max({(corner[0] - center).squaredNorm(), (corner[1] - center).squaredNorm(),
                      (corner[2] - center).squaredNorm()});
        spheres_[t] = {center, std::sqrt(radius2) * (1.0 + kSphereSlack) + 1e-12};
    });
}

Vec3 SurfaceProximity::Surface::edge_normal(int e) const
{
    Vec3 sum = Vec3::Zero();
    for (const int t : edges.triangles.of(e))
        sum += face_normals[t];
    return unit_or_zero(sum);
}

Vec3 SurfaceProximity::Surface::vertex_normal(int v) const
{
    Vec3 sum = Vec3::Zero();
    for (const int corner : edges.corners_of_vertex.of(v)) {
        const int t = corner / 3;
        const Vec3& x = corners_[corner];
        const Vec3 next = corners_[3 * t + (corner + 1) % 3] - x;
        const Vec3 previous = corners_[3 * t + (corner + 2) % 3] - x;
        sum += std::atan2(next.cross(previous).norm(), next.dot(previous)) * face_normals[t];
    }
    return unit_or_zero(sum);
}

SurfacePoint SurfaceProximity::Surface::surface_point(const NearTriangle& near, const Vec3& p) const
{
    const int t = near.triangle;
    const ClosestOnTriangle& closest = near.closest;
    SurfacePoint result{t, closest.feature, closest.barycentric, closest.point, face_normals[t], 0.0};
    if (const int k = edge_of(closest.feature); k >= 0)
        result.normal = edge_normal(edges.triangle_edge[t][k]);
    else if (const int v = vertex_of(closest.feature); v >= 0)
        result.normal = vertex_normal(triangles[t][v]);

    // A feature without a normal: its own face's, else towards p, else up.
    const double distance = std::sqrt(closest.distance2);
    if (result.normal.isZero(0.0))
        result.normal = face_normals[t];
    if (result.normal.isZero(0.0))
        result.normal = distance > 0.0 ? Vec3((p - closest.point) / distance) : Vec3(Vec3::UnitY());
    result.signed_distance = result.normal.dot(p - closest.point) < 0.0 ? -distance : distance;
    return result;
}

/// True when no triangle that shares the closest point's edge or vertex comes nearer to the query point.
/// A sharing triangle comes nearer exactly when one of its edges out of the closest point leads nearer: its
/// angle there is below 180 degrees, so no direction between them can do what neither of them does.
bool SurfaceProximity::Surface::is_local_minimum(const NearTriangle& near, const Vec3& p) const
{
    constexpr double kAngleSlack = 1e-9;     // [-]
    constexpr double kPositionSlack = 1e-14; // [m] rounding of coordinates of a few metres
    const Vec3 towards_p = p - near.closest.point;
    const double slack = kAngleSlack * towards_p.norm() + kPositionSlack;
    const auto leads_nearer = [&](const Vec3& x) {
        const Vec3 step = x - near.closest.point;
        return towards_p.dot(step) > slack * step.norm();
    };
    const int t = near.triangle;
    if (const int k = edge_of(near.closest.feature); k >= 0) {
        const View<const int> sharing = edges.triangles.of(edges.triangle_edge[t][k]);
        return std::none_of(sharing.begin(), sharing.end(), [&](int other) {
            const Vec3* corner = &corners_[3 * other];
            return leads_nearer(corner[0]) || leads_nearer(corner[1]) || leads_nearer(corner[2]);
        });
    }
    if (const int k = vertex_of(near.closest.feature); k >= 0) {
        const View<const int> sharing = edges.corners_of_vertex.of(triangles[t][k]);
        return std::none_of(sharing.begin(), sharing.end(), [&](int corner) {
            const int first = corner - corner % 3;
            return leads_nearer(corners_[first + (corner + 1) % 3]) ||
                   leads_nearer(corners_[first + (corner + 2) % 3]);
        });
    }
    return true;
}

template <typename Visit>
void SurfaceProximity::Surface::visit(const Vec3& p, double radius, const Visit& visit) const
{
    struct Search {
        const Surface& surface;
        const Vec3& p;
        const Visit& visit;
    } search{*this, p, visit};
    const auto callback = [](RTCPointQueryFunctionArguments* arguments) -> bool {
        const auto& self = *static_cast<const Search*>(arguments->userPtr);
        const double smaller = self.visit(int(arguments->primID));
        if (smaller < 0.0)
            return false;
        arguments->query->radius = std::min(arguments->query->radius, self.surface.padded(smaller, self.p));
        return true;
    };

    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    RTCPointQuery query{float(p.x()), float(p.y()), float(p.z()), 0.0f, padded(radius, p)};
    rtcPointQuery(scene_, &query, &context, callback, &search);
}

SurfaceProximity::SurfaceProximity(View<const Triangle> triangles, View<const Vec3> positions)
    : surface_(std::make_unique<Surface>(triangles, positions.size()))
{
    surface_->move(positions);
}
SurfaceProximity::~SurfaceProximity() = default;
SurfaceProximity::SurfaceProximity(SurfaceProximity&&) noexcept = default;
SurfaceProximity& SurfaceProximity::operator=(SurfaceProximity&&) noexcept = default;

void SurfaceProximity::update(View<const Vec3> positions) { surface_->move(positions); }

std::optional<SurfacePoint> SurfaceProximity::closest(const Vec3& p, double max_distance, int hint) const
{
    NearTriangle best{-1, {}};
    best.closest.distance2 = max_distance * max_distance;
    double best_distance = max_distance;
    const auto try_triangle = [&](int t) {
        if (surface_->is_farther(t, p, best_distance))
            return -1.0;
        const ClosestOnTriangle candidate = surface_->closest_on(t, p);
        if (candidate.distance2 > best.closest.distance2 ||
            (candidate.distance2 == best.closest.distance2 && (best.triangle < 0 || t >= best.triangle)))
            return -1.0;
        best = {t, candidate};
        best_distance = std::sqrt(candidate.distance2);
        return best_distance;
    };
    if (hint >= 0)
        try_triangle(hint);
    surface_->visit(p, best_distance, try_triangle);
    if (best.triangle < 0)
        return std::nullopt;
    return surface_->surface_point(best, p);
}

SurfacePoint SurfaceProximity::closest_from(const Vec3& p, int triangle) const
{
    NearTriangle best{triangle, surface_->closest_on(triangle, p)};
    for (int last = -1; last != best.triangle;) {
        last = best.triangle;
        const auto try_triangle = [&](int t) {
            const ClosestOnTriangle candidate = surface_->closest_on(t, p);
            if (candidate.distance2 < best.closest.distance2)
                best = {t, candidate};
        };
        // Only triangles at the closest point can be nearer.
        const TriangleFeature feature = best.closest.feature;
        if (const int k = edge_of(feature); k >= 0)
            for (const int t : surface_->edges.triangles.of(surface_->edges.triangle_edge[last][k]))
                try_triangle(t);
        else if (const int c = vertex_of(feature); c >= 0)
            for (const int corner : surface_->edges.corners_of_vertex.of(surface_->triangles[last][c]))
                try_triangle(corner / 3);
    }
    return surface_->surface_point(best, p);
}

void SurfaceProximity::local_closest(const Vec3& p, double radius, std::vector<SurfacePoint>& out,
                                     const Vec3& unlike) const
{
    out.clear();
    surface_->visit(p, radius, [&](int t) {
        if (surface_->face_normals[t].dot(unlike) > kUnlikeCosine || surface_->is_farther(t, p, radius))
            return -1.0;
        const NearTriangle near{t, surface_->closest_on(t, p)};
        if (near.closest.distance2 <= radius * radius && surface_->is_local_minimum(near, p))
            out.push_back(surface_->surface_point(near, p));
        return -1.0;
    });
    std::sort(out.begin(), out.end(), [](const SurfacePoint& a, const SurfacePoint& b) {
        return std::pair(a.distance(), a.triangle) < std::pair(b.distance(), b.triangle);
    });

    // Neighbours that meet at the same point: keep the first.
    size_t kept = 0;
    for (const SurfacePoint& candidate : out) {
        const auto same = [&](const SurfacePoint& other) {
            return (candidate.point - other.point).squaredNorm() < kSamePoint * kSamePoint;
        };
        if (std::none_of(out.begin(), out.begin() + long(kept), same))
            out[kept++] = candidate;
    }
    out.resize(kept);
}

void SurfaceProximity::triangles_within(const Vec3& p, double radius, std::vector<int>& out) const
{
    out.clear();
    surface_->visit(p, radius, [&](int t) {
        if (!surface_->is_farther(t, p, radius) && surface_->closest_on(t, p).distance2 <= radius * radius)
            out.push_back(t);
        return -1.0;
    });
    std::sort(out.begin(), out.end());
}

void SurfaceProximity::triangles_maybe_within(const Vec3& p, double radius, std::vector<int>& out) const
{
    out.clear();
    surface_->visit(p, radius, [&](int t) {
        out.push_back(t);
        return -1.0;
    });
}

View<const Triangle> SurfaceProximity::triangles() const { return surface_->triangles; }
View<const Vec3> SurfaceProximity::positions() const { return surface_->positions; }
Vec3 SurfaceProximity::edge_normal(int edge) const { return surface_->edge_normal(edge); }
Vec3 SurfaceProximity::vertex_normal(int vertex) const { return surface_->vertex_normal(vertex); }
View<const Vec3> SurfaceProximity::face_normals() const { return surface_->face_normals; }
const SurfaceEdges& SurfaceProximity::edges() const { return surface_->edges; }

} // namespace toile
