#pragma once

#include <vector>

#include "core/linear/sliced_rows.h"
#include "garment/energy/membrane_kernels.h"
#include "research/methods/block_range.h"

namespace toile::garment {
struct ClothModel;
} // namespace toile::garment

namespace toile::research {

/// Constraints of a triangle, in the layout for a GPU thread.
template <typename T>
struct alignas(16) StrainItem {
    int corner[3];
    T rest_inv[4]; ///< [1/m] rows: hat gradients of corners 1 and 2
    T area;        ///< [m^2]
};

/// A curvature stencil, in the layout for a GPU thread.
template <typename T>
struct alignas(16) CurvatureItem {
    int first, count; ///< entries
    T stiffness[3];   ///< [N m^3] rows uu, uv, vv
};
template <typename T>
struct alignas(16) CurvatureItemEntry {
    int vertex;
    T weight[3]; ///< [1/m^2]
};

/// ConstraintLayout without lanes: the same colours, with the items of a colour in the order of colouring,
/// which keeps neighbours together.
/// @tparam T  type of the arithmetic: float or double
template <typename T>
struct ConstraintTable {
    std::vector<BlockRange> strain_colours, curvature_colours; ///< of items
    std::vector<StrainItem<T>> strains;
    std::vector<CurvatureItem<T>> curvatures;
    std::vector<CurvatureItemEntry<T>> entries;

    garment::MembraneWeights weights;
    SlicedRows bending;         ///< K [N/m]
    double fastest_bending;     ///< [1/s^2] bound on the eigenvalues of K / m
    std::vector<double> masses; ///< [vertices] [kg]

    explicit ConstraintTable(const garment::ClothModel& cloth);
};

extern template struct ConstraintTable<float>;
extern template struct ConstraintTable<double>;

} // namespace toile::research
