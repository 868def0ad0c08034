#include "core/pd/energy/sliced_energy.h"

namespace toile {

namespace {

void append_moved(const Triplets& entries, int first, Triplets& out)
{
    for (const auto& entry : entries)
        out.emplace_back(first + entry.row(), first + entry.col(), entry.value());
}

} // namespace

SlicedEnergy::SlicedEnergy(std::shared_ptr<Energy> energy, int first, int count)
    : energy_(std::move(energy)), first_(first), count_(count)
{
}

void SlicedEnergy::add_hessian(Triplets& H) const
{
    Triplets local;
    energy_->add_hessian(local);
    append_moved(local, first_, H);
}

double SlicedEnergy::add_gradient(View<const Vec3> x, View<Vec3> gradient)
{
    return energy_->add_gradient(x.subview(first_, count_), gradient.subview(first_, count_));
}

void SlicedEnergy::add_constant_curvature(Triplets& S) const
{
    Triplets local;
    energy_->add_constant_curvature(local);
    append_moved(local, first_, S);
}

void SlicedEnergy::add_couplings(std::vector<std::pair<int, int>>& couplings) const
{
    std::vector<std::pair<int, int>> local;
    energy_->add_couplings(local);
    for (const auto& [i, j] : local)
        couplings.emplace_back(first_ + i, first_ + j);
}

void SlicedEnergy::add_curvature(View<const Vec3> x, Definiteness definiteness, BlockWindow K)
{
    energy_->add_curvature(x.subview(first_, count_), definiteness, K.from(first_));
}

} // namespace toile
