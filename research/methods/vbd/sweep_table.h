#pragma once

#include <vector>

#include "core/linear/sliced_rows.h"
#include "garment/energy/membrane_kernels.h"
#include "research/methods/block_range.h"

namespace toile::garment {
struct ClothModel;
} // namespace toile::garment

namespace toile::research {

/// A vertex of a sweep, in the layout for a team of GPU threads.
template <typename T>
struct alignas(16) SweepItem {
    int vertex;
    int first_triangle, triangle_end; ///< into SweepTable::triangles
    int first_bend, bend_end;         ///< into SweepTable::bends; none if bending is lagged
    T mass;                           ///< [kg]
    T bending;                        ///< [N/m] diagonal of K; if lagged, absolute sum of its row
};

/// A triangle around a vertex, rotated so that the vertex is its corner 0.
template <typename T>
struct alignas(16) SweepTriangle {
    int corner1, corner2;
    T rest_inv[4]; ///< [1/m] rows: hat gradients of corners 1 and 2
    T area;        ///< [m^2]
};

/// An off-diagonal entry of K in its row.
template <typename T>
struct SweepBend {
    int vertex;
    T stiffness; ///< [N/m]
};

/// SweepLayout without lanes: the same colours, with the vertices of a colour in ascending order, which keeps
/// neighbours together.
/// @tparam T  type of the arithmetic: float or double
template <typename T>
struct SweepTable {
    std::vector<BlockRange> colours; ///< of items
    std::vector<SweepItem<T>> items;
    std::vector<SweepTriangle<T>> triangles;
    std::vector<SweepBend<T>> bends;

    garment::MembraneWeights weights;
    SlicedRows bending;         ///< K [N/m]
    std::vector<double> masses; ///< [vertices] [kg]

    /// @param lags_bending  if true, vertices of a colour share no triangle but may share an entry of K
    SweepTable(const garment::ClothModel& cloth, bool lags_bending);
};

extern template struct SweepTable<float>;
extern template struct SweepTable<double>;

} // namespace toile::research
