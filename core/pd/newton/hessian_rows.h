#pragma once

#include <array>
#include <vector>

#include "core/compute/lanes.h"
#include "core/pd/energy/objective.h"

namespace toile {

/// 3 x 3 matrix in single precision, column by column.
struct PaddedMat3 {
    PaddedVec3 column[3];

    TOILE_HD PaddedVec3 operator*(const PaddedVec3& p) const
    {
        PaddedVec3 result;
        for (int k = 0; k < 4; ++k)
            result.value[k] = column[0].value[k] * p.value[0] + column[1].value[k] * p.value[1] +
                              column[2].value[k] * p.value[2];
        return result;
    }
};

TOILE_HD inline PaddedMat3 padded_matrix(const Mat3& m)
{
    return {{padded(Vec3(m.col(0))), padded(Vec3(m.col(1))), padded(Vec3(m.col(2)))}};
}

/// Term of an active set that couples several vertices.
struct CouplingTerm {
    int vertex[4] = {-1, -1, -1, -1}; ///< rows, -1: unused or fixed
    float weight[4] = {0.0F, 0.0F, 0.0F, 0.0F};
    PaddedMat3 stiffness; ///< [N/m]
};

/// Hessian of a step in single precision, on the free vertices in a given order, as kernels read it:
///
///   (K p)_i = S_i p_i + sum_j K_ij (p_j - p_i) + terms
///
/// S_i is a row's sum, in double precision before it is rounded: a rigid motion of cloth costs its inertia,
/// not the rounding error of the membrane.
struct HessianRowsView {
    View<const PaddedMat3> sum;     ///< [rows] S_i
    View<const int> first, columns; ///< [rows + 1], [blocks] neighbours with a block
    View<const PaddedMat3> blocks;  ///< [blocks]
    View<const int> first_scalar,
        scalar_columns;        ///< [rows + 1], [scalars] those with a multiple of the identity
    View<const float> scalars; ///< [scalars]
    View<const CouplingTerm> terms;
    View<const int> first_entry, entries; ///< [rows + 1], 4 * term + slot; empty without terms

    TOILE_HD PaddedVec3 product(int i, View<const PaddedVec3> p, View<const PaddedVec3> term_force) const
    {
        using Four = Eigen::Array4f;
        const auto load = [](const PaddedVec3& v) {
            return Eigen::Map<const Four, Eigen::Aligned16>(v.value);
        };
        const auto times = [&](const PaddedMat3& m, const Four& v) {
            return Four(load(m.column[0]) * v[0] + load(m.column[1]) * v[1] + load(m.column[2]) * v[2]);
        };
        const Four own = load(p[i]);
        Four result = times(sum[i], own);
        for (int e = first[i]; e < first[i + 1]; ++e)
            result += times(blocks[e], load(p[columns[e]]) - own);
        for (int e = first_scalar[i]; e < first_scalar[i + 1]; ++e)
            result += scalars[e] * (load(p[scalar_columns[e]]) - own);
        if (!entries.empty())
            for (int e = first_entry[i]; e < first_entry[i + 1]; ++e)
                result += terms[entries[e] / 4].weight[entries[e] % 4] * load(term_force[entries[e] / 4]);
        PaddedVec3 stored;
        Eigen::Map<Four, Eigen::Aligned16>(stored.value) = result;
        return stored;
    }

    /// Force of a coupling term for a displacement [N].
    TOILE_HD PaddedVec3 force(int term, View<const PaddedVec3> p) const
    {
        const CouplingTerm& t = terms[term];
        PaddedVec3 moved(0.0F);
        for (int k = 0; k < 4; ++k)
            if (t.vertex[k] >= 0)
                moved += t.weight[k] * p[t.vertex[k]];
        return t.stiffness * moved;
    }
};

/// Storage of HessianRowsView on the CPU.
class HessianRows {
public:
    /// Finds the pattern for rows in this order.
    /// @param order  vertices of the rows: all that are free
    void find_pattern(const HessianParts& K, std::vector<int> order);

    /// Copies the values of K.
    void update(const HessianParts& K);

    int size() const { return int(order_.size()); }
    View<const int> order() const { return order_; }
    View<const PaddedMat3> inverse_diagonal() const { return inverse_diagonal_; } ///< [rows]
    HessianRowsView view() const
    {
        return {sum_,     first_, columns_,     blocks_, first_scalar_, scalar_columns_,
                scalars_, terms_, first_entry_, entries_};
    }

private:
    void find_terms(const std::vector<FrozenTerm>& terms);
    void update_row(const HessianParts& K, int row);

    std::vector<int> order_;  ///< [rows] vertices
    std::vector<int> row_of_; ///< [vertices] -1: fixed
    std::vector<PaddedMat3> sum_, inverse_diagonal_;
    std::vector<Mat3> term_sum_; ///< [rows] of terms with a single vertex
    std::vector<int> first_, columns_;
    std::vector<std::array<int, 2>>
        source_; ///< [blocks] entry of the row in K.blocks; in K.isotropic, -1: none
    std::vector<PaddedMat3> blocks_;
    std::vector<int> first_scalar_, scalar_columns_, scalar_source_; ///< source in K.isotropic
    std::vector<float> scalars_;
    std::vector<CouplingTerm> terms_;
    std::vector<int> first_entry_, entries_;
};

} // namespace toile
