#include "volume/mesh/quality.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace toile::volume {

double dihedral_angle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
    const Vec3 edge = b - a, m = edge.cross(c - a), n = edge.cross(d - a);
    return std::atan2(m.cross(n).norm(), m.dot(n)) * 180.0 / std::numbers::pi;
}

double smallest_dihedral(const Tet& tet, View<const Vec3> x)
{
    const Vec3 &a = x[tet[0]], &b = x[tet[1]], &c = x[tet[2]], &d = x[tet[3]];
    return std::min({dihedral_angle(a, b, c, d), dihedral_angle(a, c, b, d), dihedral_angle(a, d, b, c),
                     dihedral_angle(b, c, a, d), dihedral_angle(b, d, a, c), dihedral_angle(c, d, a, b)});
}

MeshQuality quality_of(const TetMesh& mesh)
{
    MeshQuality quality;
    quality.smallest_dihedral = mesh.tets.empty() ? 0.0 : 180.0;
    double edges = 0.0;
    for (const Tet& tet : mesh.tets) {
        const double volume = volume_of(tet, mesh.positions);
        quality.volume += volume;
        quality.inverted += volume > 0.0 ? 0 : 1;
        quality.smallest_dihedral =
            std::min(quality.smallest_dihedral, smallest_dihedral(tet, mesh.positions));
        for (int i = 0; i < 4; ++i)
            for (int j = i + 1; j < 4; ++j)
                edges += (mesh.positions[tet[j]] - mesh.positions[tet[i]]).norm();
    }
    if (!mesh.tets.empty())
        quality.mean_edge = edges / (6.0 * double(mesh.tets.size()));
    return quality;
}

} // namespace toile::volume
