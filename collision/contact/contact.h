#pragma once

#include <memory>
#include <vector>

#include "collision/contact/cloth_contact.h"
#include "collision/contact/contact_cloth.h"
#include "collision/contact/energy.h"
#include "core/pd/energy/active_set_energy.h"

namespace toile::collision {

class ContactTerms;

/// Contact of cloths with avatars, shapes and each other during a step. Finds pairs, keeps their energy,
/// searches again when the cloth has slid from where they were found, and stores friction from step to step.
/// Cloth that starts without crossings never gets any (CollisionFreeStep). Rigid bodies are cloths here,
/// except that no projection moves their vertices: only the energy moves them, and CollisionFreeStep as a
/// whole.
class Contact : public ActiveSetEnergy {
public:
    struct Settings {
        /// [-] Stiffness of a pair relative to diag(H) at its vertices. Above 25 PCG slows down; at 1 a
        /// resting vertex sinks by tens of micrometres, far less than the gap.
        double stiffness = 2.0;

        /// [m/s] Speed at which cloth found inside a collider is moved out. Bounds the force on cloth trapped
        /// between body parts and after a collider jumped.
        double recovery_speed = 1.0;

        bool face_vertex = true; ///< see DetectSettings
        bool edge_edge = true;

        bool cloth_with_cloth = false; ///< contact of cloth with itself and other cloth
    };

    /// @param triangles  [triangles] of all cloths
    /// @param positions  [vertices] start positions [m]
    /// @param cloths     in the order of their vertices
    /// @param space      device on which pairs are searched for and terms made, for a DeviceBody on it;
    ///                   borrowed. null: the CPU, for all other bodies
    Contact(View<const Triangle> triangles, View<const Vec3> positions,
            const std::vector<ContactCloth>& cloths, const std::vector<ContactCollider>& colliders,
            const Settings& settings, const CudaSpace* space = nullptr);
    ~Contact() override;

    void begin_step(const StepStart& start) override;
    bool may_be_active() const override;
    bool make_feasible(StepField x) const override;
    bool sweep_once(StepField x) const override;
    double add_gradient(View<const Vec3> x, View<Vec3> gradient) const override;
    bool activate(View<const Vec3> x) override;
    void add_hessian_product(View<const Vec3> p, View<Vec3> out) const override;
    View<const Mat3> diagonal_blocks() const override { return energy_.diagonal_blocks(); }
    void append_terms(std::vector<FrozenTerm>& terms) const override { energy_.append_frozen_terms(terms); }
    DeviceActiveSet* on_device(const CudaSpace& space) override;
    void mark_touching(StepField x, View<unsigned char> touches) override;
    bool revise(StepField x, MinimiserProgress progress) override;
    void clear(StepField x, StepField v) override;
    void resolve(StepField x, StepField v) override;
    bool is_complete() const override { return true; }
    bool keep_apart(StepField x, StepField v) override;
    void end_step(StepField x) override;
    void abandon_step() override;

    bool keeps_cloth_apart() const { return between_ != nullptr; }
    /// Surfaces that cloth is kept from crossing; null if there are none.
    const BodySurfaces* bodies() const
    {
        return between_ && !between_->bodies().surfaces().is_empty() ? &between_->bodies().surfaces()
                                                                     : nullptr;
    }
    /// Number of pairs in the last step that bodies have closed on and that cross from now on.
    int stuck_count() const { return between_ ? between_->bodies().stuck_count() : 0; }
    int first_stuck() const
    {
        return between_->bodies().first_stuck();
    } ///< a vertex of cloth of the first of them
    int first_let_through() const { return between_->bodies().let_through().first(); }
    /// Number of vertices between body parts that let one of them through (LetThrough).
    int let_through_count() const { return between_ ? between_->bodies().let_through().count() : 0; }
    bool lets_through(const Triangle& t) const
    {
        return between_ && between_->bodies().let_through().is_released(t);
    }
    /// See ContactBodies.
    void close_let_through(View<const int> crossing) { between_->bodies().close_let_through(crossing); }

    /// Marks cloth that crosses cloth at the start of the next step. Contact would keep it on the wrong side,
    /// so its pairs are exempt (ExemptPairs).
    /// @param crosses  [vertices] 1 for the corners of triangles that cross others
    void set_crossing(View<const unsigned char> crosses)
    {
        if (between_)
            between_->set_crossing(crosses);
    }

    /// Likewise with bodies.
    /// @param crossings  vertices of cloth and of bodies(), of triangles that cross
    /// @param inside     [vertices] 1: inside a body; empty: none is
    void set_body_crossings(View<const std::pair<int, int>> crossings, View<const unsigned char> inside)
    {
        between_->bodies().set_crossings(crossings, inside);
    }
    bool lets_through(int vertex) const
    {
        return between_ && between_->bodies().let_through().is_released(vertex);
    }

    /// True if a body jumps in a step of dt [s] that has been set: it was replaced rather than moved.
    bool have_bodies_jumped(double dt) { return between_ && between_->bodies().find_jumps(dt); }

    /// Discards the state of earlier steps, for cloth that was moved elsewhere.
    void forget();

    const ContactEnergy& energy() const { return energy_; } ///< without terms if they are on a GPU
    int active_count() const { return active_count_; }      ///< pressing pairs, after end_step()
    double min_gap() const { return min_gap_; } ///< [m] smallest distance of a pair, after end_step()

private:
    void find_again();
    void remember_end();

    double dt_ = 0.0;                       ///< of this step [s]
    std::unique_ptr<ClothContact> between_; ///< keeps apart; null if there is nothing to
    ContactEnergy energy_;                  ///< without terms if they are on a GPU
    std::unique_ptr<ContactTerms> terms_;
    int landings_ = 0;         ///< in this step: minimisations for changed friction limits
    int presses_ = 0;          ///< likewise: for vertices that shapes press out
    bool has_cleared_ = false; ///< in this step: pairs are newer than those stored for friction
    bool is_near_ = false;     ///< the minimum was at the last look of this step
    int active_count_ = 0;
    double min_gap_ = 0.0;
};

} // namespace toile::collision
