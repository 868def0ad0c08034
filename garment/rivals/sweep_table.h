#pragma once

#include <vector>

#include "core/linear/sliced_rows.h"
#include "garment/energy/membrane_kernels.h"
#include "garment/rivals/block_range.h"

namespace toile {

struct ClothModel;

/// A vertex of a sweep, as a team of threads of a GPU reads it.
template <typename T>
struct alignas(16) SweepItem {
    int vertex;
    int first_triangle, triangle_end; ///< into SweepTable::triangles
    int first_bend, bend_end;         ///< into SweepTable::bends; none where bending is lagged
    T mass;                           ///< [kg]
    T bending;                        ///< [N/m] diagonal of K; the sum of its row's sizes where it is lagged
};

/// A triangle around it, turned so that the vertex is its corner 0.
template <typename T>
struct alignas(16) SweepTriangle {
    int corner1, corner2;
    T rest_inv[4]; ///< [1/m] rows: hat gradients of corners 1 and 2
    T area;        ///< [m^2]
};

/// An entry of K in its row.
template <typename T>
struct SweepBend {
    int vertex;
    T stiffness; ///< [N/m]
};

/// SweepLayout without lanes: the same colours, vertices of a colour ascending, which keeps neighbours
/// together.
/// @tparam T  of the arithmetic: float or double
template <typename T>
struct SweepTable {
    std::vector<BlockRange> colours; ///< of items
    std::vector<SweepItem<T>> items;
    std::vector<SweepTriangle<T>> triangles;
    std::vector<SweepBend<T>> bends;

    MembraneWeights weights;
    SlicedRows bending;         ///< K [N/m]
    std::vector<double> masses; ///< [vertices] [kg]

    /// @param lags_bending  vertices of a colour share no triangle, but may share an entry of K
    SweepTable(const ClothModel& cloth, bool lags_bending);
};

extern template struct SweepTable<float>;
extern template struct SweepTable<double>;

} // namespace toile
