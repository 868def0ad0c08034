#include "volume/energy/rest_tets.h"

#include <algorithm>
#include <cstdio>

#include <Eigen/LU>

#include "core/base/error.h"

namespace toile::volume {

Mat3 edges_of(const Tet& tet, View<const Vec3> x)
{
    Mat3 edges;
    for (int k = 0; k < 3; ++k)
        edges.col(k) = x[tet[k + 1]] - x[tet[0]];
    return edges;
}

Eigen::Matrix<double, 4, 3> hat_gradients(const Mat3& edges_inv)
{
    Eigen::Matrix<double, 4, 3> gradients;
    gradients.bottomRows<3>() = edges_inv;
    gradients.row(0) = -edges_inv.colwise().sum();
    return gradients;
}

namespace {

/// Smallest height over longest edge of a tetrahedron [-], negative inside out.
double height_ratio(const Tet& tet, View<const Vec3> x)
{
    double largest_face = 0.0, longest_edge = 0.0; // twice the area
    for (int k = 0; k < 4; ++k) {
        const Vec3 &a = x[tet[k]], &b = x[tet[(k + 1) % 4]], &c = x[tet[(k + 2) % 4]];
        largest_face = std::max(largest_face, (b - a).cross(c - a).norm());
        longest_edge = std::max({longest_edge, (b - a).norm(), (c - a).norm()});
    }
    return 6.0 * volume_of(tet, x) / std::max(largest_face * longest_edge, 1e-300);
}

Incidence corners_of_vertices(View<const Tet> tets, int vertex_count)
{
    Incidence corners;
    corners.first.assign(size_t(vertex_count) + 1, 0);
    for (const Tet& tet : tets)
        for (const int v : tet)
            ++corners.first[v + 1];
    for (int v = 0; v < vertex_count; ++v)
        corners.first[v + 1] += corners.first[v];
    corners.items.resize(4 * size_t(tets.size()));
    std::vector<int> next(corners.first.begin(), corners.first.end() - 1);
    for (int t = 0; t < tets.size(); ++t)
        for (int k = 0; k < 4; ++k)
            corners.items[next[tets[t][k]]++] = 4 * t + k;
    return corners;
}

} // namespace

std::vector<double> RestTets::vertex_volumes() const
{
    std::vector<double> of_vertex(size_t(vertex_count()), 0.0);
    for (int t = 0; t < tet_count(); ++t)
        for (const int v : tets[t])
            of_vertex[v] += 0.25 * volumes[t];
    return of_vertex;
}

void require_no_slivers(const TetMesh& mesh, const std::string& source)
{
    for (int t = 0; t < mesh.tet_count(); ++t) {
        const double ratio = height_ratio(mesh.tets[t], mesh.positions);
        if (!(ratio >= kMinHeightRatio)) {
            char text[120];
            std::snprintf(
                text, sizeof text,
                ": tetrahedron %d has a height of %.1e of its longest edge; it must be %.0e or more", t,
                ratio, kMinHeightRatio);
            throw InvalidInput(source + text + "; mesh the body again");
        }
    }
}

RestTets rest_tets(const TetMesh& mesh, const std::string& source)
{
    require_no_slivers(mesh, source);
    RestTets rest;
    rest.tets = mesh.tets;
    for (int t = 0; t < mesh.tet_count(); ++t) {
        rest.edges_inv.push_back(edges_of(mesh.tets[t], mesh.positions).inverse());
        rest.volumes.push_back(volume_of(mesh.tets[t], mesh.positions));
    }
    rest.corners_of_vertex = corners_of_vertices(rest.tets, mesh.vertex_count());
    return rest;
}

} // namespace toile::volume
