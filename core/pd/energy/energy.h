#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "core/linear/block_matrix.h"
#include "core/linear/sparse_matrix.h"

namespace toile {

class DeviceEnergies;

/// Treatment of negative curvature.
enum class Definiteness {
    Exact,     ///< the unmodified Hessian
    Projected, ///< negative eigenvalues of each element become zero: positive semi-definite
};

/// Term W(x) of a Projective Dynamics objective,
///
///   W(x) = sum_j  w_j/2 |A_j S_j x - p_j(x)|^2,   p_j(x) = the projection of A_j S_j x      [Bouaziz et al.
///   2014]
///
/// whose constant quadratic part bounds its Hessian from above. w_j S_j^T A_j^T A_j S_j summed over j is a
/// majoriser, so a step along -H^-1 grad never increases the objective. An energy may omit what other
/// energies' parts cover or what acts in few places; the line search then ensures descent.
class Energy {
public:
    virtual ~Energy() = default;

    /// Stage name, e.g. "garment/membrane".
    virtual std::string_view name() const = 0;

    /// Adds sum_j w_j S_j^T A_j^T A_j S_j, or the required part of it, both triangles, to H [vertices x
    /// vertices] [N/m].
    virtual void add_hessian(Triplets& H) const = 0;

    /// Adds dW/dx [N] to gradient and returns W [J]. Same bits for every thread count.
    /// @param x, gradient  [vertices]
    virtual double add_gradient(View<const Vec3> x, View<Vec3> gradient) = 0;

    /// Adds the constant part of the true Hessian of W, for Newton's method [N/m]; it is equal for x, y and
    /// z. The rest has 3 x 3 blocks (add_curvature()). By default all of it is constant and equals the part
    /// in H. That is exact for quadratic energies and a bound for others.
    virtual void add_constant_curvature(Triplets& S) const { add_hessian(S); }

    /// Learns where its entries are: of the part that is equal for x, y and z, those of
    /// add_constant_curvature(), zeros among them; of the rest, those of add_couplings(). Called once, after
    /// these two and before add_isotropic_curvature() and add_curvature(). True if the former writes
    /// something.
    virtual bool find_entries(SparseWindow, BlockWindow) { return false; }

    /// Adds the part that depends on x [vertices] and is equal for x, y and z. Same bits for every thread
    /// count.
    virtual void add_isotropic_curvature(View<const Vec3>, [[maybe_unused]] SparseWindow S) {}

    /// Adds the pairs of vertices whose blocks add_curvature() writes.
    virtual void add_couplings(std::vector<std::pair<int, int>>&) const {}

    /// Adds the part that depends on x [vertices]. Same bits for every thread count.
    virtual void add_curvature(View<const Vec3>, Definiteness, BlockWindow) {}

    /// Adds itself to the terms of a body on a GPU; its vertex 0 is the body's `first_vertex`. Called once
    /// per cloth and kind, in the order of their vertices. False if it has no GPU form.
    virtual bool add_to(DeviceEnergies&, [[maybe_unused]] int first_vertex) { return false; }
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
