#include "scenes/surfaces/embedded_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "collision/bvh/triangle_tree.h"
#include "collision/geometry/distance.h"
#include "core/base/error.h"
#include "core/base/number.h"
#include "core/compute/parallel.h"
#include "core/mesh/point_text.h"

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
    double min_distance2 = std::numeric_limits<double>::infinity();
    for (size_t k = 0; k < 4; ++k)
        min_distance2 =
            std::min(min_distance2, collision::closest_on_triangle(p, x[tet[(k + 1) % 4]],
                                                                   x[tet[(k + 2) % 4]], x[tet[(k + 3) % 4]])
                                        .distance2);
    return min_distance2;
}

double longest_edge(const Tet& tet, View<const Vec3> x)
{
    double longest = 0.0;
    for (size_t a = 0; a < 4; ++a)
        for (size_t b = 0; b < a; ++b)
            longest = std::max(longest, (x[tet[a]] - x[tet[b]]).norm());
    return longest;
}

/// Largest factor of a corner farther away than the point [-], of the nearest tetrahedron outside which a
/// vertex may be. A flat one has larger factors, so that the vertex would leap when a corner moves a little.
constexpr double kMaxExtrapolation = 2.0;

/// How far p is beyond the faces, in heights of the tetrahedron [-]; 0 inside.
double extrapolation(const Vec3& p, const Tet& tet, View<const Vec3> x)
{
    return std::max(0.0, -weights_of(p, tet, x).minCoeff());
}

/// Finds tetrahedra around points, by their faces.
class TetSearch {
public:
    explicit TetSearch(const volume::TetMesh& mesh) : mesh_(mesh)
    {
        for (const Tet& tet : mesh.tets)
            for (size_t k = 0; k < 4; ++k)
                faces_.emplace_back(tet[(k + 1) % 4], tet[(k + 2) % 4], tet[(k + 3) % 4]);
        tree_.build(faces_, mesh.positions);
    }

    struct Nearest {
        int tet = -1;
        double squared_distance = std::numeric_limits<double>::infinity(); ///< [m^2]
    };

    /// The tetrahedron that contains p or is nearest to it; of several the first. A point inside has the
    /// nearest face in common with it: other faces are behind its own.
    Nearest nearest(const Vec3& p) const
    {
        Nearest nearest;
        tree_.visit_nearest(p, std::numeric_limits<double>::infinity(), [&](int face) {
            const int t = face / 4;
            const double here = squared_distance(p, mesh_.tets[size_t(t)], mesh_.positions);
            if (here < nearest.squared_distance || (here == nearest.squared_distance && t < nearest.tet))
                nearest = {t, here};
            const Triangle& f = faces_[size_t(face)];
            const View<const Vec3> x = mesh_.positions;
            return std::sqrt(collision::closest_on_triangle(p, x[f[0]], x[f[1]], x[f[2]]).distance2);
        });
        return nearest;
    }

    /// The tetrahedron that p moves with: the nearest one, unless that is too flat for a point outside; then
    /// the one, no farther away than that one is long, with the least extrapolation.
    int best(const Vec3& p, const Nearest& nearest) const
    {
        const View<const Vec3> x = mesh_.positions;
        const Tet& tet = mesh_.tets[size_t(nearest.tet)];
        double least = extrapolation(p, tet, x);
        if (nearest.squared_distance == 0.0 || least <= kMaxExtrapolation)
            return nearest.tet;
        int best = nearest.tet;
        const double radius = std::sqrt(nearest.squared_distance) + longest_edge(tet, x);
        tree_.visit_within(p, radius, Vec3::Zero(), 1.0, [&](int face) {
            const int t = face / 4;
            const double here = extrapolation(p, mesh_.tets[size_t(t)], x);
            if (here < least || (here == least && t < best)) {
                least = here;
                best = t;
            }
        });
        return best;
    }

private:
    const volume::TetMesh& mesh_;
    std::vector<Triangle> faces_; ///< four of each tetrahedron
    collision::TriangleTree tree_;
};

} // namespace

EmbeddedSurface::EmbeddedSurface(View<const Vec3> points, const volume::TetMesh& mesh,
                                 const std::string& source)
{
    const TetSearch search(mesh);
    std::vector<TetSearch::Nearest> nearest(size_t(points.size()));
    vertices_.resize(nearest.size());
    parallel_for(kCpu, "scenes/embed", points.size(), [&](int v) {
        nearest[size_t(v)] = search.nearest(points[v]);
        const Tet& tet = mesh.tets[size_t(search.best(points[v], nearest[size_t(v)]))];
        vertices_[size_t(v)] = {tet, weights_of(points[v], tet, mesh.positions)};
    });

    for (int v = 0; v < points.size(); ++v) {
        const Vec3& p = points[v];
        const double distance = std::sqrt(nearest[size_t(v)].squared_distance);
        if (distance > longest_edge(mesh.tets[size_t(nearest[size_t(v)].tet)], mesh.positions))
            throw InvalidInput(source + ": vertex " + std::to_string(v) + " at " + point_text(p) + " m is " +
                               short_text(distance) +
                               " m outside the soft body, farther than its tetrahedra are long; give it the "
                               "axes and unit of the body's file, or more tetrahedra around it");
    }
}

std::vector<Vec3> EmbeddedSurface::at(View<const Vec3> x) const
{
    std::vector<Vec3> positions(vertices_.size(), Vec3::Zero());
    parallel_for(kCpu, "scenes/embedded", int(positions.size()), [&](int v) {
        for (size_t k = 0; k < 4; ++k)
            positions[size_t(v)] +=
                vertices_[size_t(v)].weights[Eigen::Index(k)] * x[vertices_[size_t(v)].tet[k]];
    });
    return positions;
}

} // namespace toile::scenes
