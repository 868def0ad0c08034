#pragma once

#include <string>
#include <vector>

#include "volume/mesh/tet_mesh.h"

namespace toile::scenes {

/// A surface that moves with a mesh of tetrahedra: every vertex keeps its barycentric coordinates in the
/// tetrahedron that contains it or, outside all, in the nearest one. Where that is so flat that a coordinate
/// is below -2, it is the tetrahedron nearby whose lowest coordinate is the highest.
class EmbeddedSurface {
public:
    /// O((points + tetrahedra) log tetrahedra).
    /// @param points  [vertices of the surface] where `mesh` is [m]
    /// @param source  named in errors
    /// @throws InvalidInput for a vertex farther outside than the longest edge of the nearest tetrahedron
    EmbeddedSurface(View<const Vec3> points, const volume::TetMesh& mesh, const std::string& source);

    /// Positions now [vertices of the surface] [m].
    /// @param x  [vertices of the mesh] now [m]
    std::vector<Vec3> at(View<const Vec3> x) const;

private:
    struct Vertex {
        volume::Tet tet;
        Eigen::Vector4d weights; ///< of its corners, sum 1; some are negative outside
    };
    std::vector<Vertex> vertices_;
};

} // namespace toile::scenes
