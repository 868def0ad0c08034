#include "core/pd/preconditioner/sherman_morrison_inverse.h"

#include <algorithm>

#include <Eigen/LU>

#include "core/compute/parallel.h"
#include "core/pd/preconditioner/coupled_part.h"

namespace toile {

void ShermanMorrisonInverse::update(const FrozenHessian& dH, View<const double> D,
                                    View<const unsigned char> fixed)
{
    D_ = D;
    shared_.update(dH.diagonal_blocks(), D);
    disjoint_ = free_terms(dH, fixed);

    // Keep the terms that share no vertex with another one. The bound is exact for terms of one vertex.
    std::vector<int> term_count(D.size(), 0);
    for (const FrozenTerm& term : disjoint_)
        for (int k = 0; k < 4; ++k)
            if (term.weight[k] != 0.0)
                ++term_count[term.vertex[k]];
    std::erase_if(disjoint_, [&](const FrozenTerm& term) {
        if (term.vertex[1] < 0)
            return true;
        for (int k = 0; k < 4; ++k)
            if (term.weight[k] != 0.0 && term_count[term.vertex[k]] > 1)
                return true;
        return false;
    });

    for (FrozenTerm& term : disjoint_) {
        double s = 0.0;
        for (int k = 0; k < 4; ++k)
            if (term.weight[k] != 0.0)
                s += term.weight[k] * term.weight[k] / D[term.vertex[k]];
        term.stiffness = (Mat3::Identity() + s * term.stiffness).inverse() * term.stiffness;
    }
}

void ShermanMorrisonInverse::apply(View<const Vec3> r, View<Vec3> z) const
{
    shared_.apply(r, z);
    parallel_for(kCpu, "pd/nested_contacts", int(disjoint_.size()), [&](int i) {
        const FrozenTerm& term = disjoint_[i];
        Vec3 point = Vec3::Zero(); // displacement of the contact's point by D alone
        for (int k = 0; k < 4; ++k)
            if (term.weight[k] != 0.0)
                point += term.weight[k] / D_[term.vertex[k]] * r[term.vertex[k]];
        const Vec3 force = term.stiffness * point;
        for (int k = 0; k < 4; ++k)
            if (term.weight[k] != 0.0) {
                const int v = term.vertex[k];
                z[v] = (r[v] - term.weight[k] * force) / D_[v];
            }
    });
}

} // namespace toile
