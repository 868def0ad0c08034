#include "core/pd/energy/curvature.h"

#include <algorithm>

#include "core/compute/parallel.h"

namespace toile {

Curvature::Curvature(int vertex_count, std::vector<std::shared_ptr<Energy>> energies)
    : energies_(std::move(energies))
{
    Triplets entries;
    for (int i = 0; i < vertex_count; ++i) // the diagonal exists even without energies
        entries.emplace_back(i, i, 0.0);
    std::vector<std::pair<int, int>> couplings;
    for (const auto& energy : energies_) {
        energy->add_constant_curvature(entries);
        energy->add_couplings(couplings);
    }
    isotropic_.resize(vertex_count, vertex_count);
    isotropic_.setFromTriplets(entries.begin(), entries.end());
    blocks_ = BlockMatrix(vertex_count, couplings);
    bool changes = false;
    for (const auto& energy : energies_)
        changes = energy->find_entries(isotropic_, blocks_) || changes;
    if (changes)
        constant_.assign(isotropic_.valuePtr(), isotropic_.valuePtr() + isotropic_.nonZeros());
}

void Curvature::assemble(View<const Vec3> x, Definiteness definiteness)
{
    const StageScope stage("pd/curvature");
    std::copy(constant_.begin(), constant_.end(), isotropic_.valuePtr());
    blocks_.set_zero();
    for (const auto& energy : energies_) {
        energy->add_isotropic_curvature(x, isotropic_);
        energy->add_curvature(x, definiteness, blocks_);
    }
}

} // namespace toile
