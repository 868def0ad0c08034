#pragma once

#include <array>

#include "core/compute/lanes.h"

namespace toile {

/// Row of a frozen term's Hessian at one of its vertices, in single precision and stored contiguously:
/// self_weight A u with u = sum_k weight_k p_k.
struct alignas(16) FrozenRow {
    std::array<int, 4> vertex; ///< -1: unused, at the end
    std::array<float, 4> weight;
    float self_weight;
    float xx, xy, xz, yy, yz, zz; ///< A [N/m]

    static TOILE_HD FrozenRow of(const std::array<int, 4>& vertex, const std::array<double, 4>& weight,
                                 int slot, const Mat3& A)
    {
        return {vertex,
                {float(weight[0]), float(weight[1]), float(weight[2]), float(weight[3])},
                float(weight[slot]),
                float(A(0, 0)),
                float(A(0, 1)),
                float(A(0, 2)),
                float(A(1, 1)),
                float(A(1, 2)),
                float(A(2, 2))};
    }

    TOILE_HD Mat3 stiffness() const
    {
        Mat3 A;
        A(0, 0) = double(xx);
        A(1, 1) = double(yy);
        A(2, 2) = double(zz);
        A(0, 1) = A(1, 0) = double(xy);
        A(0, 2) = A(2, 0) = double(xz);
        A(1, 2) = A(2, 1) = double(yz);
        return A;
    }

    /// @param p  [vertices] [m]
    TOILE_HD Vec3 times(View<const PaddedVec3> p) const
    {
        PaddedVec3 u(0.0F);
        for (int k = 0; k < 4 && vertex[k] >= 0; ++k)
            u += weight[k] * p[vertex[k]];
        return double(self_weight) * Vec3(double(xx * u[0] + xy * u[1] + xz * u[2]),
                                          double(xy * u[0] + yy * u[1] + yz * u[2]),
                                          double(xz * u[0] + yz * u[1] + zz * u[2]));
    }
};

/// The list of terms that belongs to a vertex.
struct ListOfVertex {
    View<const int> number; ///< [vertices that may have one] of the vertex's list plus 1; 0: none

    /// -1: none
    TOILE_HD int operator[](int vertex) const { return vertex < number.size() ? number[vertex] - 1 : -1; }
};

/// Rows of active frozen terms by vertex: list k begins at first[k] and has active_count[k] rows.
struct FrozenRows {
    View<const int> first;  ///< [lists + 1]
    View<int> active_count; ///< [lists]
    View<FrozenRow> rows;
};

/// Terms of an ActiveSetEnergy on a GPU between begin_step() and revise(), as the host found them. Functions
/// enqueue unless they say otherwise; all fields are on the device.
class DeviceActiveSet {
public:
    /// Frozen Hessian by vertex: one "list" of terms per vertex with frozen terms.
    struct Frozen {
        ListOfVertex list_of;
        View<const int> vertices; ///< [lists]
        FrozenRows rows;
        View<const Mat3> blocks;  ///< [lists] bounds, as FrozenHessian::diagonal_blocks() [N/m]
        View<const Vec3> product; ///< [lists] result of the last multiply() [N]
    };

    virtual ~DeviceActiveSet() = default;

    /// False if the host has found no candidate terms.
    virtual bool has_terms() const = 0;

    /// Adds the gradient [N] and parts of the energy [J] at x [vertices] [m], and freezes the terms active
    /// there.
    virtual void evaluate(View<const Vec3> x, View<Vec3> gradient, View<double> energy) = 0;

    /// Multiplies the frozen Hessian by p [vertices] [m].
    virtual void multiply(View<const PaddedVec3> p) = 0;

    virtual Frozen frozen() const = 0;
};

} // namespace toile
