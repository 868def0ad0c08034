#pragma once

#include <vector>

#include "core/pd/energy/active_set_energy.h"
#include "core/pd/rigid/rigid_bodies.h"

namespace toile {

/// Adapter of an energy on surfaces, contact above all, to a body of free points and rigid bodies. The energy
/// uses the free points, followed by the vertices of all rigid surfaces. The minimiser uses the free points,
/// followed by the unknowns of RigidBodies.
///
/// Gradients map back through J^T, Hessians as J^T dH J (Gauss-Newton: without the rotation of the levers),
/// bounds as RigidBodies::bound. Every evaluation applies the rigid map again, so bodies stay rigid up to
/// rounding.
class RigidActiveSet : public ActiveSetEnergy {
public:
    /// @param surface     acts on [free_count + bodies.vertex_count()] vertices; borrowed
    /// @param bodies      borrowed; its begin_step() precedes this one
    /// @param free_count  points before the unknowns of the bodies
    RigidActiveSet(ActiveSetEnergy& surface, const RigidBodies& bodies, int free_count);

    void begin_step(const StepStart& start) override;
    bool make_feasible(StepField q) const override;
    bool sweep_once(StepField q) const override;
    double add_gradient(View<const Vec3> q, View<Vec3> gradient) const override;
    bool activate(View<const Vec3> q) override;
    void add_hessian_product(View<const Vec3> p, View<Vec3> out) const override;
    View<const Mat3> diagonal_blocks() const override { return blocks_; }

    /// Appends only the free points' part of terms at a rigid surface: a FrozenTerm cannot represent levers.
    /// Preconditioners from terms are therefore less accurate for bodies than those from diagonal_blocks().
    void append_terms(std::vector<FrozenTerm>& terms) const override;
    bool has_all_terms() const override { return false; }

    bool may_be_active() const override { return surface_.may_be_active(); }
    void mark_touching(StepField q, View<unsigned char> touches) override;
    bool revise(StepField q, MinimiserProgress progress) override;
    void clear(StepField q, StepField v) override;
    bool keep_apart(StepField q, StepField v) override;
    void end_step(StepField q) override;
    void abandon_step() override { surface_.abandon_step(); }

private:
    template <typename Projection>
    bool project_free(StepField positions, const Projection& projection) const;
    void to_surface(View<const Vec3> q, View<Vec3> x) const;
    void take_free(View<const Vec3> x, View<Vec3> q) const;
    View<Vec3> rigid_part(View<Vec3> x) const { return x.subview(free_count_, bodies_.vertex_count()); }
    View<Vec3> unknowns(View<Vec3> q) const { return q.subview(free_count_, bodies_.unknown_count()); }
    View<const Vec3> unknowns(View<const Vec3> q) const
    {
        return q.subview(free_count_, bodies_.unknown_count());
    }
    void take_moved(View<const Vec3> before, View<const Vec3> x, View<Vec3> q) const;

    ActiveSetEnergy& surface_;
    const RigidBodies& bodies_;
    int free_count_;
    double dt_ = 0.0;
    std::vector<Vec3> start_, prediction_; ///< [vertices]
    std::vector<double> diagonal_;         ///< [vertices]
    std::vector<unsigned char> fixed_;     ///< [vertices]
    RigidBodies::Tangent frozen_;
    std::vector<Mat3> blocks_;             ///< [free points, unknowns]
    mutable std::vector<Vec3> x_, field_;  ///< [vertices] scratch
    mutable RigidBodies::Tangent tangent_; ///< scratch
};

} // namespace toile
