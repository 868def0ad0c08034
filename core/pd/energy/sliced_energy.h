#pragma once

#include <memory>

#include "core/pd/energy/energy.h"

namespace toile {

/// Energy of one cloth in a body of several: it uses only its own vertices, numbered from 0.
class SlicedEnergy : public Energy {
public:
    /// @param first  vertex of the body that is the energy's vertex 0
    /// @param count  of the energy's vertices
    SlicedEnergy(std::shared_ptr<Energy> energy, int first, int count);

    std::string_view name() const override { return energy_->name(); }
    void add_hessian(Triplets& H) const override;
    double add_gradient(View<const Vec3> x, View<Vec3> gradient) override;
    void add_constant_curvature(Triplets& S) const override;
    bool find_entries(SparseWindow S, BlockWindow K) override
    {
        return energy_->find_entries(S.from(first_), K.from(first_));
    }
    void add_isotropic_curvature(View<const Vec3> x, SparseWindow S) override
    {
        energy_->add_isotropic_curvature(x.subview(first_, count_), S.from(first_));
    }
    void add_couplings(std::vector<std::pair<int, int>>& couplings) const override;
    void add_curvature(View<const Vec3> x, Definiteness definiteness, BlockWindow K) override;
    bool add_to(DeviceEnergies& energies, int first_vertex) override
    {
        return energy_->add_to(energies, first_ + first_vertex);
    }

private:
    std::shared_ptr<Energy> energy_;
    int first_, count_;
};

} // namespace toile
