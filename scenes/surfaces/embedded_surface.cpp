#include "scenes/surfaces/embedded_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "collision/geometry/distance.h"
#include "core/base/error.h"
#include "core/base/number.h"
#include "core/compute/parallel.h"

namespace toile::scenes {

namespace {

using volume::Tet;

/// Barycentric coordinates of p in a tetrahedron that is not flat.
Eigen::Vector4d weights_of(const Vec3& p, const Tet& tet, View<const Vec3> x)
{
    Mat3 edges;
    for (int k = 0; k < 3; ++k)
        edges.col(k) = x[tet[size_t(k) + 1]] - x[tet[0]];
    const Vec3 weights = edges.inverse() * (p - x[tet[0]]);
    return {1.0 - weights.sum(), weights[0], weights[1], weights[2]};
}

/// Squared distance from p to a tetrahedron, 0 inside [m^2].
double squared_distance(const Vec3& p, const Tet& tet, View<const Vec3> x)
{
    if ((weights_of(p, tet, x).array() >= 0.0).all())
        return 0.0;
    double least = std::numeric_limits<double>::infinity();
    for (size_t k = 0; k < 4; ++k)
        least = std::min(least, collision::closest_on_triangle(p, x[tet[(k + 1) % 4]], x[tet[(k + 2) % 4]],
                                                               x[tet[(k + 3) % 4]])
                                    .distance2);
    return least;
}

double longest_edge(const Tet& tet, View<const Vec3> x)
{
    double longest = 0.0;
    for (size_t a = 0; a < 4; ++a)
        for (size_t b = 0; b < a; ++b)
            longest = std::max(longest, (x[tet[a]] - x[tet[b]]).norm());
    return longest;
}

struct Nearest {
    int tet = -1;
    double squared_distance = std::numeric_limits<double>::infinity(); ///< [m^2]
};

/// @param boxes  [tets] around them
Nearest nearest_tet(const Vec3& p, const volume::TetMesh& mesh, View<const Bounds> boxes)
{
    Nearest nearest;
    for (int t = 0; t < mesh.tet_count() && nearest.squared_distance > 0.0; ++t) {
        const Vec3 beside = (boxes[t].lower - p).cwiseMax(p - boxes[t].upper).cwiseMax(0.0);
        if (beside.squaredNorm() >= nearest.squared_distance)
            continue;
        const double here = squared_distance(p, mesh.tets[size_t(t)], mesh.positions);
        if (here < nearest.squared_distance)
            nearest = {t, here};
    }
    return nearest;
}

} // namespace

EmbeddedSurface::EmbeddedSurface(View<const Vec3> points, const volume::TetMesh& mesh,
                                 const std::string& source)
{
    std::vector<Bounds> boxes(mesh.tets.size());
    for (size_t t = 0; t < boxes.size(); ++t)
        for (const int v : mesh.tets[t])
            boxes[t].extend(mesh.positions[size_t(v)]);
    std::vector<Nearest> nearest(size_t(points.size()));
    parallel_for(kCpu, "scenes/embed", points.size(),
                 [&](int v) { nearest[size_t(v)] = nearest_tet(points[v], mesh, boxes); });

    for (int v = 0; v < points.size(); ++v) {
        const Vec3& p = points[v];
        const Tet& tet = mesh.tets[size_t(nearest[size_t(v)].tet)];
        const double distance = std::sqrt(nearest[size_t(v)].squared_distance);
        if (distance > longest_edge(tet, mesh.positions))
            throw InvalidInput(source + ": vertex " + std::to_string(v) + " at (" + short_text(p.x()) + ", " +
                               short_text(p.y()) + ", " + short_text(p.z()) + ") m is " +
                               short_text(distance) +
                               " m outside the soft body, farther than its tetrahedra are long; give it the "
                               "axes and unit of the body's file, or more tetrahedra around it");
        vertices_.push_back({tet, weights_of(p, tet, mesh.positions)});
    }
}

std::vector<Vec3> EmbeddedSurface::at(const std::function<Vec3(int vertex)>& x) const
{
    std::vector<Vec3> positions(vertices_.size(), Vec3::Zero());
    for (size_t v = 0; v < vertices_.size(); ++v)
        for (size_t k = 0; k < 4; ++k)
            positions[v] += vertices_[v].weights[Eigen::Index(k)] * x(vertices_[v].tet[k]);
    return positions;
}

} // namespace toile::scenes
