#include "core/pd/preconditioner/paper_projection.h"

#include <Eigen/Eigenvalues>

#include "core/base/stages.h"
#include "core/pd/preconditioner/coupled_part.h"

namespace toile {

void PaperProjection::update(const FrozenHessian& dH, View<const double> inertia,
                             View<const unsigned char> fixed)
{
    inertia_ = inertia;
    terms_ = free_terms(dH, fixed);
    W_.assign(inertia.size(), 0.0);
    q_.resize(inertia.size());
    for (FrozenTerm& term : terms_) {
        const double w = term.stiffness.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff();
        double weight2 = 0.0;
        for (int k = 0; k < 4; ++k)
            if (term.weight[k] != 0.0) {
                weight2 += term.weight[k] * term.weight[k];
                W_[term.vertex[k]] += w;
            }
        if (weight2 > 0.0)
            term.stiffness /= weight2;
    }
}

void PaperProjection::apply(View<const Vec3> r, View<Vec3> z) const
{
    const StageScope stage("pd/paper_projection");
    for (int i = 0; i < r.size(); ++i)
        q_[i] = r[i] / inertia_[i];
    for (int iteration = 0; iteration < kIterations; ++iteration) {
        for (int i = 0; i < r.size(); ++i)
            z[i] = r[i] + W_[i] * q_[i];
        for (const FrozenTerm& term : terms_) {
            Vec3 point = Vec3::Zero();
            for (int k = 0; k < 4; ++k)
                if (term.weight[k] != 0.0)
                    point += term.weight[k] * q_[term.vertex[k]];
            const Vec3 resisted = term.stiffness * point;
            for (int k = 0; k < 4; ++k)
                if (term.weight[k] != 0.0)
                    z[term.vertex[k]] -= term.weight[k] * resisted;
        }
        for (int i = 0; i < r.size(); ++i)
            q_[i] = z[i] / (inertia_[i] + W_[i]);
    }
    for (int i = 0; i < r.size(); ++i)
        z[i] = inertia_[i] * q_[i];
}

} // namespace toile
