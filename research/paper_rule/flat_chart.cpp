#include "research/paper_rule/flat_chart.h"

#include <cmath>

#include <Eigen/Geometry>

namespace toile::research {

namespace {

/// Distance from the common plane, relative to the mesh's size, up to which a mesh counts as flat [-]. Files
/// hold six digits.
constexpr double kFlat = 1e-5;

Vec3 area_vector(const TriangleMesh& mesh, const Triangle& t)
{
    const Vec3& corner = mesh.positions[t[0]];
    return (mesh.positions[t[1]] - corner).cross(mesh.positions[t[2]] - corner);
}

} // namespace

std::optional<std::vector<Vec2>> flat_chart(const TriangleMesh& mesh)
{
    // Compute the mean normal, which every triangle must share.
    Vec3 normal = Vec3::Zero();
    for (const Triangle& t : mesh.triangles)
        normal += area_vector(mesh, t);
    normal.normalize();
    for (const Triangle& t : mesh.triangles)
        if (!(area_vector(mesh, t).dot(normal) > 0.0))
            return std::nullopt;

    const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
    const double tolerance = kFlat * bounds(mesh.positions).diagonal();
    std::vector<Vec2> chart;
    chart.reserve(mesh.positions.size());
    for (const Vec3& p : mesh.positions) {
        const Vec3 from = p - mesh.positions[0];
        if (!(std::abs(from.dot(normal)) <= tolerance))
            return std::nullopt;
        chart.emplace_back(from.dot(u), from.dot(v));
    }
    return chart;
}

} // namespace toile::research
