#pragma once

#include "core/compute/lanes.h"

namespace toile::research {

/// Constraints of a curvature stencil: the three vectors row_k x are zero, with compliances 1 / stiffness_k.
/// Their energies 1/2 |C|^2 / alpha add up to Bending's. Vertices are added one by one.
template <typename T>
class CurvatureConstraints {
public:
    TOILE_HD CurvatureConstraints()
    {
        for (int k = 0; k < 3; ++k) {
            C_[k] = Vec3Of<T>(T(0.0), T(0.0), T(0.0));
            for (T& product : G_[k])
                product = T(0.0);
        }
    }

    /// @param weight      [1/m^2] of the vertex in the rows uu, uv, vv
    /// @param mobility    [1/kg] 0 if fixed
    /// @param from_first  offset from the stencil's first vertex [m]; rows sum to zero
    TOILE_HD void add(const T (&weight)[3], const T& mobility, const Vec3Of<T>& from_first)
    {
        for (int k = 0; k < 3; ++k) {
            C_[k] += weight[k] * from_first;
            for (int l = k; l < 3; ++l)
                G_[k][l] += mobility * weight[k] * weight[l];
        }
    }

    /// Makes one Gauss-Seidel pass: d lambda_k = -C_k / (G_kk + 1 / (h^2 stiffness_k)), G = rows M^-1 rows^T.
    /// @param stiffness  [N m^3]
    /// @param h          substep [s]
    TOILE_HD void project(const T (&stiffness)[3], double h)
    {
        for (int k = 0; k < 3; ++k) {
            const T scaled = T(h * h) * stiffness[k];
            multiplier_[k] = (-scaled / (scaled * G_[k][k] + T(1.0))) * C_[k];
            for (int l = k + 1; l < 3; ++l)
                C_[l] += G_[k][l] * multiplier_[k];
        }
    }

    /// Multiplier after project(): a vertex moves by sum_k mobility weight_k multiplier(k).
    TOILE_HD const Vec3Of<T>& multiplier(int k) const { return multiplier_[k]; }

private:
    Vec3Of<T> C_[3], multiplier_[3];
    T G_[3][3];
};

} // namespace toile::research
