#pragma once

#include <string_view>
#include <vector>

#include "core/linear/sparse_matrix.h"

namespace toile {

/// One term W(x) of a Projective Dynamics objective,
///
///   W(x) = sum_j  w_j/2 |A_j S_j x - p_j(x)|^2,   p_j(x) = the projection of A_j S_j x      [Bouaziz et al.
///   2014]
///
/// whose constant quadratic part bounds its Hessian from above: w_j S_j^T A_j^T A_j S_j summed over j is a
/// majoriser, so a step along -H^-1 grad never increases the objective. An energy may leave out what the
/// others' share covers or what acts in few places; the line search then answers for descent.
class Energy {
public:
    virtual ~Energy() = default;

    /// Stage name, e.g. "garment/membrane".
    virtual std::string_view name() const = 0;

    /// Adds sum_j w_j S_j^T A_j^T A_j S_j or what is needed of it, both triangles, to H [vertices x vertices]
    /// [N/m].
    virtual void add_hessian(Triplets& H) const = 0;

    /// Adds dW/dx [N] to gradient and returns W [J]. Same bits for every thread count.
    /// @param x, gradient  [vertices]
    virtual double add_gradient(View<const Vec3> x, View<Vec3> gradient) = 0;
};

/// Diagonal of an energy's part of H [vertices] [N/m].
inline std::vector<double> hessian_diagonal(const Energy& energy, int vertex_count)
{
    Triplets entries;
    energy.add_hessian(entries);
    std::vector<double> diagonal(vertex_count, 0.0);
    for (const auto& entry : entries)
        if (entry.row() == entry.col())
            diagonal[entry.row()] += entry.value();
    return diagonal;
}

} // namespace toile
