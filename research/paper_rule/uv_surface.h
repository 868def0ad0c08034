#pragma once

#include <optional>
#include <vector>

#include "core/linear/sparse_matrix.h"
#include "research/paper_rule/pixel_grid.h"

namespace toile::research {

/// Triangle surface in its UV plane under a grid of pixels: the form of a mesh that the paper's rule needs.
/// Panels lie side by side and must not overlap.
class UvSurface {
public:
    /// Point as a mixture of three vertices.
    struct Barycentric {
        Triangle vertex;
        Vec3 weight; ///< [-] non-negative, sum 1
    };

    /// @param uv         [vertices] positions in the plane [m]
    /// @param triangles  [triangles] counter-clockwise in the plane
    /// @param pixels     of the grid along the longer side of the bounding box, at least 1
    /// @throws InvalidInput naming the first vertex that is not finite or belongs to no triangle, or the
    ///         first triangle that is out of range, flipped or without area
    UvSurface(View<const Vec2> uv, View<const Triangle> triangles, int pixels);

    int vertex_count() const { return int(uv_.size()); }
    const Vec2& uv(int vertex) const { return uv_[vertex]; }
    const PixelGrid& grid() const { return grid_; }

    /// Covered pixel that the vertex belongs to: the one in which it lies. A border vertex between pixels
    /// belongs to the one that holds most of its area.
    const Pixel& pixel_of(int vertex) const { return pixel_of_vertex_[vertex]; }

    /// Lumped area |Omega_k| = integral of the vertex's shape function N_k [m^2] [multilevel quadrature for
    /// PD, eq. 10].
    double area(int vertex) const { return area_[vertex]; }

    /// Integrals of the shape functions over the pixels, [pixels x vertices] [m^2]; columns sum to area().
    /// Triangles are cut into pieces of less than half a pixel, and each piece counts for the pixel that
    /// holds its centre.
    const SparseMatrix& coverage() const { return coverage_; }

    /// Flag of each pixel, [pixels]: 1 if a part of the surface lies in it; `flag` of Alg. 1, line 4.
    const std::vector<char>& is_covered() const { return is_covered_; }

    /// Barycentric coordinates of a point on the surface; nothing if the point lies beside it.
    std::optional<Barycentric> locate(const Vec2& point) const;

private:
    void require_usable() const;
    void measure_coverage();
    void find_pixels_of_vertices();
    void sort_into_pixels();

    std::vector<Vec2> uv_;
    std::vector<Triangle> triangles_;
    PixelGrid grid_;
    std::vector<double> area_;
    SparseMatrix coverage_;
    std::vector<char> is_covered_;
    std::vector<Pixel> pixel_of_vertex_;
    std::vector<std::vector<int>> triangles_of_pixel_; ///< triangles whose bounding boxes overlap the pixel
};

} // namespace toile::research
