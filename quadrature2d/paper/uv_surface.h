#pragma once

#include <optional>
#include <vector>

#include "core/linear/sparse_matrix.h"
#include "quadrature2d/paper/pixel_grid.h"

namespace toile {

/// A triangle surface spread out in its UV plane under a grid of pixels: what the paper's rule asks of a
/// mesh. Panels lie side by side and must not overlap.
class UvSurface {
public:
    /// A point as a mixture of three vertices.
    struct Barycentric {
        Triangle vertex;
        Vec3 weight; ///< [-] non-negative, sum 1
    };

    /// @param uv         [vertices] positions in the plane [m]
    /// @param triangles  [triangles] counter-clockwise in the plane
    /// @param pixels     of the grid along the longer side of the bounding box, at least 1
    /// @throws InvalidInput naming the first vertex that is not finite or belongs to no triangle, or the
    /// first
    ///                      triangle that is out of range, flipped or without area
    UvSurface(View<const Vec2> uv, View<const Triangle> triangles, int pixels);

    int vertex_count() const { return int(uv_.size()); }
    const Vec2& uv(int vertex) const { return uv_[vertex]; }
    const PixelGrid& grid() const { return grid_; }

    /// The covered pixel that the vertex belongs to: the one it lies in, or, for a vertex of the border that
    /// lies between pixels, the one that holds most of its area.
    const Pixel& pixel_of(int vertex) const { return pixel_of_vertex_[vertex]; }

    /// Lumped area |Omega_k| = integral of the vertex's shape function N_k [m^2]   [multilevel quadrature,
    /// eq. 10]
    double area(int vertex) const { return area_[vertex]; }

    /// Integrals of the shape functions over the pixels, [pixels x vertices] [m^2]; columns sum to area().
    /// Triangles are cut into pieces of less than half a pixel, and each piece counts for the pixel that
    /// holds its centre.
    const SparseMatrix& coverage() const { return coverage_; }

    /// [pixels] 1 where a part of the surface lies in the pixel: `flag` of Alg. 1, line 4.
    const std::vector<char>& is_covered() const { return is_covered_; }

    /// Where the point lies on the surface; nothing where it lies beside it.
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
    std::vector<std::vector<int>> triangles_of_pixel_; ///< whose bounding boxes touch it
};

} // namespace toile
