#pragma once

#include "collision/contact/term.h"

namespace toile::collision {

/// Force [N] and energy [J] of a term at x.
struct EvaluateContact {
    View<const ContactTerm> terms;
    View<const Vec3> x;  ///< [vertices] [m]
    View<Vec3> force;    ///< [terms] out: gradient with respect to the cloth point
    View<double> energy; ///< [terms] out

    TOILE_HD void operator()(int i) const { (*this)(i, terms[i]); }
    TOILE_HD void operator()(int i, const ContactTerm& term) const
    {
        const double depth = -term.gap(x);
        Vec3 f = -term.spring.force(depth) * term.pair.normal;
        double e = term.spring.energy(depth);

        if (term.friction_limit() > 0.0) {
            const Vec3 u = term.slip(x);
            const double length = u.norm();
            f += term.tangential_stiffness(length) * u;
            e += term.friction_energy(length);
        }
        force[i] = f;
        energy[i] = e;
    }
};

/// Freezes the Hessian of a term at x.
struct FreezeContact {
    View<const ContactTerm> terms;
    View<const Vec3> x;         ///< [vertices] [m]
    bool is_true;               ///< see StepStart::wants_true_hessian
    View<FrozenContact> frozen; ///< [terms] out

    TOILE_HD void operator()(int i) const { (*this)(i, terms[i]); }
    TOILE_HD void operator()(int i, const ContactTerm& term) const
    {
        FrozenContact at;
        at.normal = term.spring.stiffness_at(-term.gap(x));
        if (term.friction_limit() > 0.0) {
            const Vec3 slip = term.slip(x);
            const double length = slip.norm();
            at.tangential = term.tangential_stiffness(length);
            if (is_true && term.is_sliding(length))
                at.sliding = slip / length;
        }
        frozen[i] = at;
    }
};

/// Product of a frozen term's Hessian with a move p of its vertices [N].
struct MultiplyContact {
    View<const ContactTerm> terms;
    View<const FrozenContact> frozen; ///< [terms]
    View<const Vec3> p;               ///< [vertices] [m]
    View<Vec3> force;                 ///< [terms] out

    TOILE_HD void operator()(int i) const
    {
        const ContactPair& pair = terms[i].pair;
        force[i] =
            frozen[i].is_active() ? frozen[i].times(pair.normal, pair.cloth_point(p)) : Vec3(0.0, 0.0, 0.0);
    }
};

/// Lists of terms by vertex.
struct ContactIncidence {
    View<const ContactTerm> terms;
    View<const int> first;   ///< [lists + 1] into entries
    View<const int> entries; ///< 4 * term + slot, ascending in each list

    /// sum of weight * force over the terms of list k
    TOILE_HD Vec3 force(int k, View<const Vec3> of_term) const
    {
        Vec3 sum(0.0, 0.0, 0.0);
        for (int e = first[k]; e < first[k + 1]; ++e) {
            const Vec3& of_this = of_term[entries[e] / 4];
            if (of_this != Vec3(0.0, 0.0, 0.0)) // most do not press
                sum += terms[entries[e] / 4].pair.weight[entries[e] % 4] * of_this;
        }
        return sum;
    }

    /// Contribution of list k's terms to the bound of the frozen Hessian at its vertex.
    TOILE_HD Mat3 block(int k, View<const FrozenContact> frozen) const
    {
        Mat3 sum = Mat3::Zero();
        for (int e = first[k]; e < first[k + 1]; ++e)
            if (const int term = entries[e] / 4; frozen[term].is_active())
                sum += bound_at(terms[term].pair, entries[e] % 4, frozen[term]);
        return sum;
    }

    /// |b_k| (sum_j |b_j|) A_p of pair p. Summed over all pairs of its vertex k, it bounds the frozen Hessian
    /// at that vertex (Cauchy-Schwarz).
    TOILE_HD static Mat3 bound_at(const ContactPair& pair, int k, const FrozenContact& frozen)
    {
        const double total = pair.is_between_cloths() ? 2.0 : 1.0; // sum of a pair's |weights|
        const double weight = pair.weight[k];
        return (weight < 0.0 ? -weight : weight) * total * frozen.bound(pair.normal);
    }
};

} // namespace toile::collision
