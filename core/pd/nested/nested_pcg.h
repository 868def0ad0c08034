#pragma once

#include <memory>
#include <vector>

#include "core/linear/pcg.h"
#include "core/pd/nested/contact_inverse.h"
#include "core/pd/nested/contact_preconditioner.h"
#include "core/pd/nested/paper_projection.h"
#include "core/pd/system.h"

namespace toile {

/// An inverse of D + dH by its name. Null for Paper, which is none.
std::unique_ptr<ContactInverse> make_contact_inverse(ContactPreconditioner which);

/// (H + dH) z = g by conjugate gradients, around the paper's nesting of a contact solve and the
/// collision-free solve, symmetrised so that it converges (docs/core/nested_pcg.md):
///
///   P r = E r + E D H^-1 D E r,   E = (D + dH)^-1 or near it,  D = diag(H)
///
/// Stage "pd/pcg"; nothing of this exists where no contact presses.
class NestedPcg {
public:
    struct Settings {
        ContactPreconditioner preconditioner = ContactPreconditioner::Block;
        /// What the inside of a quasi-Newton method needs is a direction, not a solution: four iterations, or
        /// a tenth of the residual. Fewer leave friction wrong. Where cloth lands, a few stiff pairs stop all
        /// of its weight, and an iteration for each gains more and more.
        /// Flexible in any case where the global solver is not symmetric.
        Pcg::Settings pcg{.tolerance = 0.1, .max_iterations = 20, .least_gain = 1.2, .least_iterations = 4};
    };

    /// @param system  prepared, borrowed
    /// @param dt      [s]
    NestedPcg(const System& system, double dt, const Settings& settings);

    /// Prepares for another dH, borrowed until the next update.
    void update(const FrozenHessian& dH);

    /// @param g, z  [vertices] [N], [m]
    Pcg::Outcome solve(View<const Vec3> g, View<Vec3> z);

    /// out = (H + dH) p. @param p  [vertices]; out is p where vertices are fixed
    void multiply(View<const Vec3> p, View<Vec3> out) const;

    /// z = P r
    void precondition(View<const Vec3> r, View<Vec3> z);

private:
    const System& system_;
    Settings settings_;
    const FrozenHessian* dH_ = nullptr;
    std::unique_ptr<ContactInverse> E_; ///< null with the paper's preconditioner
    PaperProjection paper_;
    std::vector<double> inertia_; ///< [vertices] m/dt^2 [N/m], for the paper's
    Pcg pcg_;
    std::vector<Vec3> Er_, solved_; ///< scratch
};

} // namespace toile
