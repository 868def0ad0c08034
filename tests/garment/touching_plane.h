#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "collision/contact/cuda/energy.h"
#include "collision/contact/energy.h"
#include "core/pd/energy/active_set_energy.h"

namespace toile::test {

using namespace collision;

/// Contact of every vertex with a plane, with given normal forces. The objective is constant during the
/// minimisation, so that another solver can minimise it too.
class TouchingPlane : public ActiveSetEnergy {
public:
    struct Settings {
        Vec3 normal = Vec3::UnitY(); ///< unit
        double height = 0.0;         ///< [m] of the plane along its normal
        double stiffness = 100.0;    ///< [N/m]
        double friction = 0.0;       ///< [-]
        double normal_force = 0.0;   ///< [N] that limits friction
    };

    TouchingPlane(const std::vector<Vec3>& start, const Settings& settings) : vertex_count_(int(start.size()))
    {
        std::vector<ContactTerm> terms(start.size());
        for (size_t v = 0; v < start.size(); ++v) {
            terms[v].pair.vertex[0] = int(v);
            terms[v].pair.weight[0] = 1.0;
            terms[v].pair.normal = settings.normal;
            terms[v].pair.point = settings.height * settings.normal;
            terms[v].spring.stiffness = settings.stiffness;
            terms[v].friction = settings.friction;
            terms[v].normal_force = settings.normal_force;
            terms[v].anchor = start[v];
        }
        energy_.set_terms(std::move(terms), int(start.size()));
    }

    /// Creates contact from arbitrary terms.
    TouchingPlane(std::vector<ContactTerm> terms, int vertex_count) : vertex_count_(vertex_count)
    {
        energy_.set_terms(std::move(terms), vertex_count);
    }

    void begin_step(const StepStart& start) override
    {
        has_true_hessian_ = start.wants_true_hessian;
        energy_.use_true_hessian(has_true_hessian_);
        device_energy_.reset();
    }
    bool make_feasible(StepField) const override { return false; }
    bool sweep_once(StepField) const override { return false; }
    double add_gradient(View<const Vec3> x, View<Vec3> gradient) const override
    {
        return energy_.add_gradient(x, gradient);
    }
    bool activate(View<const Vec3> x) override { return energy_.activate(x); }
    void add_hessian_product(View<const Vec3> p, View<Vec3> out) const override
    {
        energy_.add_hessian_product(p, out);
    }
    View<const Mat3> diagonal_blocks() const override { return energy_.diagonal_blocks(); }
    void append_terms(std::vector<FrozenTerm>& terms) const override { energy_.append_frozen_terms(terms); }
    DeviceActiveSet* on_device(const CudaSpace& space) override
    {
        if (!device_energy_) {
            device_energy_ = std::make_unique<DeviceContactEnergy>(space);
            device_energy_->use_true_hessian(has_true_hessian_);
            device_energy_->set_terms(energy_.terms(), vertex_count_);
        }
        return device_energy_.get();
    }
    bool revise(StepField, MinimiserProgress) override { return false; }
    void clear(StepField, StepField) override {}
    bool keep_apart(StepField, StepField) override { return false; }
    void end_step(StepField) override {}

    /// Number of vertices that press on the plane at x.
    int pressing(const std::vector<Vec3>& x) const
    {
        int count = 0;
        for (int v = 0; v < int(x.size()); ++v)
            count += energy_.gap(v, x) < 0.0 ? 1 : 0;
        return count;
    }

    /// Number of pressing vertices that slide.
    int sliding(const std::vector<Vec3>& x) const
    {
        int count = 0;
        for (int v = 0; v < int(x.size()); ++v) {
            const ContactTerm& term = energy_.terms()[v];
            const bool slides =
                term.sticking_stiffness() * energy_.slip(v, x).norm() > term.friction * term.normal_force;
            count += energy_.gap(v, x) < 0.0 && slides ? 1 : 0;
        }
        return count;
    }

private:
    int vertex_count_;
    bool has_true_hessian_ = false;
    ContactEnergy energy_;
    std::unique_ptr<DeviceContactEnergy> device_energy_;
};

} // namespace toile::test
