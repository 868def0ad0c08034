#pragma once

#include <vector>

#include "collision/contact/kernels.h"
#include "core/pd/energy/frozen_hessian.h"

namespace toile::collision {

/// Contact and friction of cloth, with colliders and with cloth, as an energy of the cloth's positions.
///
/// Normal, with the gap g = n . (sum_k b_k x_k - p) - offset: W_n is ContactSpring's at the depth -g.
///
/// Friction is elastic up to Coulomb's limit L = mu |f_n| with the lagged normal force f_n, then slides: with
/// u = (I - n n^T)(sum_k b_k x_k - anchor) and the stiffness k = min(w, L / u_s) of sticking,
///
///   W_t = k/2 |u|^2            while k |u| <= L
///         L |u| - L^2 / (2 k)  beyond (Huber), so that the force k u is projected onto the disc of radius L
///
/// Both are convex. The frozen Hessian replaces the sliding part by its reweighted majoriser L/|u|, unless it
/// is to be the true one: friction that slides does not resist further sliding.
class ContactEnergy {
public:
    /// @param vertex_count  of the cloth
    void set_terms(std::vector<ContactTerm> terms, int vertex_count);

    const std::vector<ContactTerm>& terms() const { return terms_; }
    View<ContactTerm> change_terms() { return terms_; } ///< vertices must not change

    /// Adds the gradient [N] and returns the energy [J].
    double add_gradient(View<const Vec3> x, View<Vec3> gradient) const;

    /// See StepStart::wants_true_hessian.
    void use_true_hessian(bool use) { has_true_hessian_ = use; }

    /// Freezes the Hessian blocks at x. False if no term is active.
    bool activate(View<const Vec3> x);
    void add_hessian_product(View<const Vec3> p, View<Vec3> out) const;
    void append_frozen_terms(std::vector<FrozenTerm>& terms) const;

    /// Per vertex sum_p |b_k| (sum_j |b_j|) A_p: bounds the frozen Hessian (Cauchy-Schwarz).
    View<const Mat3> diagonal_blocks() const { return blocks_; }

    /// Gap g of a term at x [m]; negative if it presses.
    double gap(int term, View<const Vec3> x) const { return terms_[term].gap(x); }
    /// Part of anchor-to-cloth in the tangent plane, u above [m].
    Vec3 slip(int term, View<const Vec3> x) const { return terms_[term].slip(x); }

    /// Lists of terms by vertex.
    struct TermIncidence {
        std::vector<int> vertices; ///< of the terms, ascending
        std::vector<int> first;    ///< [vertices + 1] into entries
        std::vector<int> entries;  ///< 4 * term + slot

        void clear();
        void add(int vertex, int entry); ///< in ascending order of vertices
        void close() { first.push_back(int(entries.size())); }
    };
    const TermIncidence& incidence() const { return incidence_; } ///< of all terms

private:
    void find_active_incidence();
    void gather(const TermIncidence& incidence, View<Vec3> out) const;

    std::vector<ContactTerm> terms_;
    TermIncidence incidence_;           ///< of all terms
    TermIncidence active_incidence_;    ///< of active terms: usually far fewer
    std::vector<int> active_;           ///< active terms
    std::vector<FrozenContact> frozen_; ///< [terms] A_p
    bool has_true_hessian_ = false;
    std::vector<Mat3> blocks_;             ///< [vertices]
    mutable std::vector<Vec3> term_force_; ///< [terms] scratch
    mutable std::vector<double> term_energy_;
};

} // namespace toile::collision
