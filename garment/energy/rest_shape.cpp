#include "garment/energy/rest_shape.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace toile::garment {

namespace {

/// Sine of the angle below which the grain counts as perpendicular to a triangle [-].
constexpr double kMinGrainProjection = 0.05;

/// Unit warp direction in the plane of a triangle.
Vec3 warp_direction(const Vec3& normal, const Vec3& grain)
{
    const Vec3 along = grain.normalized();
    for (const Vec3& candidate :
         {along, Vec3(along.y(), along.z(), along.x()), Vec3(along.z(), along.x(), along.y())}) {
        const Vec3 projected = candidate - normal.dot(candidate) * normal;
        if (projected.norm() > kMinGrainProjection)
            return projected.normalized();
    }
    return normal.unitOrthogonal();
}

/// Maximum longest edge over its altitude of a triangle that is not a sliver [-].
constexpr double kMaxAspect = 20.0;

/// Completes a shape that has triangles and edges with areas and topology.
RestShape complete(RestShape shape, Topology topology)
{
    shape.topology = std::move(topology);
    shape.edges_inv.reserve(shape.edges.size());
    shape.areas.reserve(shape.edges.size());
    for (const Mat2& edges : shape.edges) {
        shape.edges_inv.push_back(edges.inverse());
        shape.areas.push_back(0.5 * std::abs(edges.determinant()));
    }
    return shape;
}

} // namespace

bool RestShape::is_sliver(int triangle) const
{
    const Mat2& edge = edges[triangle];
    const double longest = std::max(
        {edge.col(0).squaredNorm(), edge.col(1).squaredNorm(), (edge.col(1) - edge.col(0)).squaredNorm()});
    return longest > kMaxAspect * 2.0 * areas[triangle];
}

std::vector<double> RestShape::vertex_areas() const
{
    std::vector<double> result(vertex_count(), 0.0);
    for (size_t t = 0; t < triangles.size(); ++t)
        for (const int v : triangles[t])
            result[v] += areas[t] / 3.0;
    return result;
}

RestShape part_of(const RestShape& rest, const std::vector<int>& triangles)
{
    RestShape part;
    std::vector<int> number(rest.triangles.size(), -1); // in the part
    for (const int t : triangles) {
        number[size_t(t)] = int(part.triangles.size());
        part.triangles.push_back(rest.triangles[size_t(t)]);
        part.edges.push_back(rest.edges[size_t(t)]);
        part.edges_inv.push_back(rest.edges_inv[size_t(t)]);
        part.areas.push_back(rest.areas[size_t(t)]);
    }
    part.topology.corners_of_vertex = corners_of_vertices(part.triangles, rest.vertex_count());
    part.topology.triangle_edge.resize(triangles.size());
    for (size_t e = 0; e < rest.topology.edges.size(); ++e) {
        const Edge& whole = rest.topology.edges[e];
        Edge edge;
        int count = 0;
        for (int side = 0; side < 2; ++side) {
            if (whole.triangle[side] < 0 || number[size_t(whole.triangle[side])] < 0)
                continue;
            if (count == 0) // triangle[0] runs along the edge
                edge.vertex = side == 0 ? whole.vertex : std::array{whole.vertex[1], whole.vertex[0]};
            edge.triangle[count] = number[size_t(whole.triangle[side])];
            edge.opposite[count++] = whole.opposite[side];
            const std::array<int, 3>& edges = rest.topology.triangle_edge[size_t(whole.triangle[side])];
            const auto k = size_t(std::find(edges.begin(), edges.end(), int(e)) - edges.begin());
            part.topology.triangle_edge[size_t(edge.triangle[count - 1])][k] =
                int(part.topology.edges.size());
        }
        if (count > 0)
            part.topology.edges.push_back(edge);
    }
    return part;
}

RestShape rest_shape_of_pattern(const std::vector<Vec2>& uv, const std::vector<Triangle>& triangles,
                                const std::string& source)
{
    TriangleMesh flat;
    flat.triangles = triangles;
    for (const Vec2& p : uv)
        flat.positions.emplace_back(p.x(), p.y(), 0.0);
    require_usable(flat, source);

    RestShape shape;
    shape.triangles = triangles;
    for (const Triangle& t : triangles) {
        Mat2 edges;
        edges << uv[t[1]] - uv[t[0]], uv[t[2]] - uv[t[0]];
        shape.edges.push_back(edges);
    }
    return complete(std::move(shape), build_topology(triangles, int(uv.size()), source));
}

RestShape rest_shape_of_surface(const TriangleMesh& mesh, const Vec3& grain, double rotation,
                                const std::string& source)
{
    require_usable(mesh, source);
    RestShape shape;
    shape.triangles = mesh.triangles;
    for (const Triangle& t : mesh.triangles) {
        const Vec3 e1 = mesh.positions[t[1]] - mesh.positions[t[0]];
        const Vec3 e2 = mesh.positions[t[2]] - mesh.positions[t[0]];
        const Vec3 normal = e1.cross(e2).normalized();
        const Vec3 straight = warp_direction(normal, grain);
        const Vec3 u = std::cos(rotation) * straight + std::sin(rotation) * normal.cross(straight);
        const Vec3 v = normal.cross(u);
        Mat2 edges;
        edges << u.dot(e1), u.dot(e2), v.dot(e1), v.dot(e2);
        shape.edges.push_back(edges);
    }
    return complete(std::move(shape), build_branching_topology(mesh, source));
}

RestShape rest_shape_of_panels(const TriangleMesh& mesh, const std::vector<FlatTriangle>& panels,
                               double rotation, const std::string& source)
{
    require_usable(mesh, source);
    RestShape shape;
    shape.triangles = mesh.triangles;
    Mat2 material_from_panel; // rows u along the warp, v
    material_from_panel << -std::sin(rotation), std::cos(rotation), -std::cos(rotation), -std::sin(rotation);
    for (const FlatTriangle& corner : panels) {
        Mat2 edges;
        edges << corner[1] - corner[0], corner[2] - corner[0];
        edges = material_from_panel * edges;
        if (edges.determinant() < 0.0)
            edges.row(1) *= -1.0; // mirror about the warp
        shape.edges.push_back(edges);
    }
    return complete(std::move(shape), build_branching_topology(mesh, source));
}

} // namespace toile::garment
