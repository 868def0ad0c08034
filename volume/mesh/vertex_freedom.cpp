#include "volume/mesh/vertex_freedom.h"

#include <algorithm>
#include <map>
#include <utility>

#include <Eigen/Geometry>

namespace toile::volume {

namespace {

/// Cosine of the angle up to which a surface is smooth: between faces at an edge, and between a face and the
/// mean normal at a vertex.
constexpr double kSmooth = 0.7;

Vec3 area_normal(const Triangle& t, View<const Vec3> x)
{
    return 0.5 * (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
}

} // namespace

VertexFreedom vertex_freedom(View<const Vec3> x, View<const Triangle> surface)
{
    VertexFreedom freedom{std::vector<Freedom>(x.size(), Freedom::Space),
                          std::vector<Vec3>(x.size(), Vec3::Zero())};
    std::map<std::pair<int, int>, Vec3> normal_beside;
    for (const Triangle& face : surface)
        for (int k = 0; k < 3; ++k) {
            const int a = face[k], b = face[(k + 1) % 3];
            const Vec3 normal = area_normal(face, x);
            freedom.normal[a] += normal;
            if (freedom.of[a] == Freedom::Space)
                freedom.of[a] = Freedom::Plane;
            const auto [beside, is_first] = normal_beside.try_emplace(std::minmax(a, b), normal);
            if (!is_first && beside->second.normalized().dot(normal.normalized()) < kSmooth)
                freedom.of[a] = freedom.of[b] = Freedom::None;
        }
    for (const Triangle& face : surface)
        for (const int v : face)
            if (area_normal(face, x).normalized().dot(freedom.normal[v].normalized()) < kSmooth)
                freedom.of[v] = Freedom::None;
    return freedom;
}

} // namespace toile::volume
