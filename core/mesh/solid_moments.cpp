#include "core/mesh/solid_moments.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/base/error.h"
#include "core/mesh/point_text.h"
#include "core/mesh/topology.h"

namespace toile {

namespace {

/// Min volume of a solid over the cube of its bounding box's diagonal [-]. Rounding alone would rotate
/// thinner ones about their flat axes.
constexpr double kThinnest = 1e-9;

void require_closed(const TriangleMesh& surface, const std::string& source)
{
    const Topology topology = build_topology(surface.triangles, surface.vertex_count(), source);
    for (const Edge& edge : topology.edges)
        if (edge.is_border())
            throw InvalidInput(source + ": the edge from " + point_text(surface.positions[edge.vertex[0]]) +
                               " to " + point_text(surface.positions[edge.vertex[1]]) +
                               " has one triangle only, so there is no inside; give a closed surface");
}

} // namespace

SolidMoments solid_moments(const TriangleMesh& surface, const std::string& source)
{
    require_closed(surface, source);
    const Bounds box = bounds(surface.positions);
    const Vec3 origin = box.center(); // near the solid, so that little cancels

    // A tetrahedron (0, a, b, c) has volume a . (b x c) / 6. Its integral of X X^T is volume / 20 times the
    // sum of the corners' squares and the square of their sum.
    SolidMoments all;
    Vec3 first = Vec3::Zero();
    for (const Triangle& t : surface.triangles) {
        const Vec3 a = surface.positions[t[0]] - origin, b = surface.positions[t[1]] - origin,
                   c = surface.positions[t[2]] - origin, sum = a + b + c;
        const double volume = a.dot(b.cross(c)) / 6.0;
        all.volume += volume;
        first += volume / 4.0 * sum;
        all.second += volume / 20.0 *
                      (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
    }
    if (all.volume < 0.0)
        throw InvalidInput(source + ": the surface is inside out (volume " + std::to_string(all.volume) +
                           " m^3); turn its triangles counter-clockwise seen from outside");
    if (!(all.volume > kThinnest * std::pow(box.diagonal(), 3)))
        throw InvalidInput(source + ": the surface holds no volume; a solid needs some thickness");
    const Vec3 centre = first / all.volume;
    all.second -= all.volume * centre * centre.transpose();
    all.centre = origin + centre;
    return all;
}

} // namespace toile
