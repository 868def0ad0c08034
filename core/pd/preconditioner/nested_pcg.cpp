#include "core/pd/preconditioner/nested_pcg.h"

#include "core/pd/preconditioner/block_inverse.h"
#include "core/pd/preconditioner/chebyshev_inverse.h"
#include "core/pd/preconditioner/exact_inverse.h"
#include "core/pd/preconditioner/sherman_morrison_inverse.h"

namespace toile {

std::unique_ptr<ContactInverse> make_contact_inverse(ContactPreconditioner which)
{
    switch (which) {
    case ContactPreconditioner::Block:
        return std::make_unique<BlockInverse>();
    case ContactPreconditioner::Exact:
        return std::make_unique<ExactInverse>();
    case ContactPreconditioner::ShermanMorrison:
        return std::make_unique<ShermanMorrisonInverse>();
    case ContactPreconditioner::Chebyshev:
        return std::make_unique<ChebyshevInverse>();
    case ContactPreconditioner::Paper:
        break;
    }
    return nullptr;
}

NestedPcg::NestedPcg(const System& system, double dt, const Settings& settings)
    : system_(system), settings_(settings), E_(make_contact_inverse(settings.preconditioner)),
      Er_(system.vertex_count()), solved_(system.vertex_count())
{
    settings_.pcg.is_flexible = settings.pcg.is_flexible || !system.solver().is_symmetric();
    if (!E_)
        for (const double mass : system.masses())
            inertia_.push_back(mass / (dt * dt));
}

void NestedPcg::update(const FrozenHessian& dH)
{
    const StageScope stage("pd/nested_update");
    dH_ = &dH;
    if (E_)
        E_->update(dH, system_.diagonal(), system_.fixed());
    else
        paper_.update(dH, inertia_, system_.fixed());
}

Pcg::Outcome NestedPcg::solve(View<const Vec3> g, View<Vec3> z)
{
    const StageScope stage("pd/pcg");
    const auto K = [&](View<const Vec3> p, View<Vec3> out) { multiply(p, out); };
    const auto P = [&](View<const Vec3> r, View<Vec3> out) { precondition(r, out); };
    return pcg_.solve(K, P, g, z, settings_.pcg);
}

void NestedPcg::multiply(View<const Vec3> p, View<Vec3> out) const
{
    const SparseMatrix& H = system_.matrix();
    const View<const unsigned char> fixed = system_.fixed();
    parallel_for(kCpu, "pd/multiply", p.size(), [&](int i) { out[i] = row_times(H, i, p); });
    dH_->add_hessian_product(p, out);
    for (int i = 0; i < p.size(); ++i)
        if (fixed[i])
            out[i] = p[i];
}

void NestedPcg::precondition(View<const Vec3> r, View<Vec3> z)
{
    const StageScope stage("pd/nested");
    if (!E_) {
        paper_.apply(r, solved_);
        system_.solver().solve(solved_, z);
        return;
    }
    const View<const double> D = system_.diagonal();
    E_->apply(r, Er_);
    parallel_for(
        kCpu, "pd/nested_scale", r.size(), [&](int i) { solved_[i] = D[i] * Er_[i]; }, kFieldGrain);
    system_.solver().solve(solved_, solved_);
    parallel_for(
        kCpu, "pd/nested_scale", r.size(), [&](int i) { solved_[i] = r[i] + D[i] * solved_[i]; },
        kFieldGrain);
    E_->apply(solved_, z);
}

} // namespace toile
