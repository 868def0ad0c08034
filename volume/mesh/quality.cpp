#include "volume/mesh/quality.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace toile::volume {

namespace {

/// Angle between the faces of a tetrahedron at its edge from corner i to j [rad].
double dihedral_angle(const Tet& tet, View<const Vec3> x, int i, int j)
{
    const int k = (i != 0 && j != 0) ? 0 : (i != 1 && j != 1) ? 1 : 2;
    const int l = 6 - i - j - k;
    const Vec3 edge = x[tet[j]] - x[tet[i]];
    const Vec3 a = edge.cross(x[tet[k]] - x[tet[i]]), b = edge.cross(x[tet[l]] - x[tet[i]]);
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

} // namespace

MeshQuality quality_of(const TetMesh& mesh)
{
    MeshQuality quality;
    double smallest = std::numbers::pi, edges = 0.0;
    for (const Tet& tet : mesh.tets) {
        const double volume = volume_of(tet, mesh.positions);
        quality.volume += volume;
        quality.inverted += volume > 0.0 ? 0 : 1;
        for (int i = 0; i < 4; ++i)
            for (int j = i + 1; j < 4; ++j) {
                smallest = std::min(smallest, dihedral_angle(tet, mesh.positions, i, j));
                edges += (mesh.positions[tet[j]] - mesh.positions[tet[i]]).norm();
            }
    }
    if (!mesh.tets.empty()) {
        quality.smallest_dihedral = smallest * 180.0 / std::numbers::pi;
        quality.mean_edge = edges / (6.0 * double(mesh.tets.size()));
    }
    return quality;
}

} // namespace toile::volume
