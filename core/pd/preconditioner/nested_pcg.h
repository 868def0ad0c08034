#pragma once

#include <memory>
#include <vector>

#include "core/linear/pcg.h"
#include "core/pd/energy/system.h"
#include "core/pd/preconditioner/contact_inverse.h"
#include "core/pd/preconditioner/contact_preconditioner.h"
#include "core/pd/preconditioner/paper_projection.h"

namespace toile {

/// Approximate inverse of D + dH by name. Null for Paper, which has none.
std::unique_ptr<ContactInverse> make_contact_inverse(ContactPreconditioner which);

/// Solver of (H + dH) z = g by conjugate gradients, around the paper's nesting of a contact solve and the
/// collision-free solve, symmetrised so that it converges (docs/theory/nested_pcg.md):
///
///   P r = E r + E D H^-1 D E r,   E = (D + dH)^-1 or near it,  D = diag(H)
///
/// Stage "pd/pcg"; not created without active contact.
class NestedPcg {
public:
    struct Settings {
        ContactPreconditioner preconditioner = ContactPreconditioner::Block;
        /// A quasi-Newton method needs a direction, not a solution: four iterations, or a tenth of the
        /// residual. Fewer iterations give wrong friction. When cloth lands, a few stiff pairs stop all of
        /// its weight; they take an iteration each, with increasing gains. Flexible in any case if the global
        /// solver is not symmetric.
        Pcg::Settings pcg{.tolerance = 0.1, .max_iterations = 20, .min_gain = 1.2, .min_iterations = 4};
    };

    /// @param system  prepared, borrowed
    /// @param dt      [s]
    NestedPcg(const System& system, double dt, const Settings& settings);

    /// Takes another dH, borrowed until the next update.
    void update(const FrozenHessian& dH);

    /// @param g, z  [vertices] [N], [m]
    Pcg::Outcome solve(View<const Vec3> g, View<Vec3> z);

    /// Computes out = (H + dH) p. @param p  [vertices]; out is p at fixed vertices
    void multiply(View<const Vec3> p, View<Vec3> out) const;

    /// Computes z = P r.
    void precondition(View<const Vec3> r, View<Vec3> z);

private:
    const System& system_;
    Settings settings_;
    const FrozenHessian* dH_ = nullptr;
    std::unique_ptr<ContactInverse> E_; ///< null with the paper's preconditioner
    PaperProjection paper_;
    std::vector<double> inertia_; ///< [vertices] m/dt^2 [N/m], for paper_
    Pcg pcg_;
    std::vector<Vec3> Er_, solved_; ///< scratch
};

} // namespace toile
