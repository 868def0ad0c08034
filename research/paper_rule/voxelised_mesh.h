#pragma once

#include <optional>
#include <type_traits>
#include <vector>

#include "core/linear/sparse_matrix.h"
#include "research/paper_rule/voxel_grid.h"

namespace toile::research {

/// Corners of a triangle (Dim = 2) or of a tetrahedron (Dim = 3), positively oriented.
template <int Dim>
using Simplex = std::conditional_t<Dim == 2, Triangle, std::array<int, Dim + 1>>;

/// Mesh under a grid of voxels, the form that the paper's rule needs: triangles in their UV plane (Dim = 2)
/// or tetrahedra (Dim = 3). Panels lie side by side and must not overlap.
template <int Dim>
class VoxelisedMesh {
public:
    using Weights = Eigen::Matrix<double, Dim + 1, 1>;

    /// Point as a mixture of the corners of a simplex.
    struct Barycentric {
        Simplex<Dim> vertex;
        Weights weight; ///< [-] non-negative, sum 1
    };

    /// @param positions  [vertices] [m]
    /// @param simplices  positively oriented
    /// @param voxels     of the grid along the longest side of the bounding box, at least 1
    /// @throws InvalidInput naming the first vertex that is not finite or belongs to no simplex, or the first
    ///         simplex that is out of range, inside out or flat
    VoxelisedMesh(View<const Point<Dim>> positions, View<const Simplex<Dim>> simplices, int voxels);

    int vertex_count() const { return int(positions_.size()); }
    const Point<Dim>& position(int vertex) const { return positions_[vertex]; }
    const VoxelGrid<Dim>& grid() const { return grid_; }

    /// Covered voxel that the vertex belongs to: the one in which it lies. A border vertex between voxels
    /// belongs to the one that holds most of its volume.
    const Voxel<Dim>& voxel_of(int vertex) const { return voxel_of_vertex_[vertex]; }

    /// Lumped area or volume |Omega_k| = integral of the vertex's shape function N_k [m^Dim] [multilevel
    /// quadrature for PD, eq. 10].
    double volume(int vertex) const { return volume_[vertex]; }

    /// Integrals of the shape functions over the voxels, [voxels x vertices] [m^Dim]; columns sum to
    /// volume(). Simplices are cut into pieces of about half a voxel, and each piece counts for the voxel
    /// that holds its centre.
    const SparseMatrix& coverage() const { return coverage_; }

    /// Flag of each voxel, [voxels]: 1 if a part of the mesh lies in it; `flag` of Alg. 1, line 4.
    const std::vector<char>& is_covered() const { return is_covered_; }

    /// Barycentric coordinates of a point on the mesh; nothing if the point lies beside it.
    std::optional<Barycentric> locate(const Point<Dim>& point) const;

private:
    void read_simplices();
    Box<Dim> box_of(const Simplex<Dim>& simplex) const;
    void measure_coverage();
    void find_voxels_of_vertices();
    void sort_into_voxels();

    std::vector<Point<Dim>> positions_;
    std::vector<Simplex<Dim>> simplices_;
    std::vector<Eigen::Matrix<double, Dim, Dim>>
        edges_inv_;                      ///< [simplices] inverse of x_a - x_0, a > 0 [1/m]
    std::vector<double> simplex_volume_; ///< [simplices] [m^Dim]
    VoxelGrid<Dim> grid_;
    std::vector<double> volume_;
    SparseMatrix coverage_;
    std::vector<char> is_covered_;
    std::vector<Voxel<Dim>> voxel_of_vertex_;
    std::vector<std::vector<int>> simplices_of_voxel_; ///< simplices whose bounding boxes overlap the voxel
};

} // namespace toile::research
