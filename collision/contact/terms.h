#pragma once

#include <memory>
#include <vector>

#include "collision/body/colliders.h"
#include "collision/contact/cloth_contact.h"
#include "collision/contact/contact_cloth.h"
#include "collision/contact/projections.h"
#include "collision/contact/rules.h"
#include "core/pd/energy/active_set_energy.h"

namespace toile {
class CudaSpace;
class DeviceActiveSet;
} // namespace toile

namespace toile::collision {

/// Terms of Contact during a step: their construction from pairs with colliders, which this class finds, and
/// pairs of cloth with cloth; their queries; and the contact memory of friction. HostContactTerms has them on
/// the CPU, DeviceContactTerms on a GPU, the same terms in the same order.
class ContactTerms : public NearbyBodies {
public:
    struct Settings {
        double stiffness = 0.0, recovery_speed = 0.0; ///< see Contact::Settings
        bool face_vertex = true, edge_edge = true;
    };

    using Slip = RememberedSlip;

    ContactTerms() = default;
    ContactTerms(const ContactTerms&) = delete;
    ContactTerms& operator=(const ContactTerms&) = delete;

    /// Finds the pairs with colliders of a step.
    /// @param carried  see ClothContact
    virtual void begin_step(const StepStart& start, View<const Vec3> carried) = 0;

    /// Makes the terms of these pairs and of those of `between`, which may be null. Pairs that cannot move at
    /// all make none. Faces and edges with a caught vertex are left to the planes of their vertices.
    virtual void make(const ClothContact* between) = 0;

    virtual bool empty() const = 0;

    /// Sets the positions [vertices] [m] that the functions below use, as they are when these are called.
    virtual void see(StepField x) = 0;

    /// Updates how hard the terms press. Returns the sums of friction's limits by that.
    virtual TermSums update_forces() = 0;

    /// Bounds friction by the updated forces.
    virtual void adopt_forces() = 0;

    /// Presses harder where the last update found less than the minimum gap. See ContactMultiplier.
    virtual void update_multipliers(bool is_near) = 0;

    /// See ActiveSetEnergy.
    virtual void mark_touching(View<unsigned char> touches) = 0;

    /// Flags [vertices]: 1 for cloth on or inside a collider.
    virtual std::vector<unsigned char> supported() = 0;

    /// True if vertices have left the region in which their pairs with colliders are valid: by more than
    /// `trust` [m] for pressing pairs. find_again() finds their new pairs.
    virtual bool has_left(double trust) = 0;
    virtual void find_again() = 0;

    /// Maximum depth in colliders at which a step would end [m]; 0 if there is none.
    virtual double deepest() = 0;

    // Moves of cloth by contact alone, term by term (projections.h).

    /// Projects positions before a minimisation (ProjectCompliant). False only if nothing moves.
    virtual bool project_compliant(int sweeps) = 0;
    /// Projects positions out of surfaces, if deeper than `max_depth` [m] (ProjectNormal).
    virtual void project_normal(double max_depth) = 0;
    /// Stops velocities [m/s] into surfaces (StopAtSurface).
    virtual void stop_at_surfaces(StepField v) = 0;
    /// Projects positions and velocities by rigid contact with friction (ProjectFriction).
    virtual void project_friction(StepField v) = 0;

    /// Stores forces and elastic slip of pressing pairs, for the warm start of their successors. The forces
    /// are the minimiser's: clearing and the strain limit move cloth afterwards, even out of contact.
    virtual void remember(Slip slip) = 0;
    virtual int remembered() const = 0; ///< number of stored pairs

    /// Updates the contact side history. Returns the smallest distance of a pair [m]; 0 if there is none.
    virtual double end_step() = 0;

    /// Stores again what was stored at the start of the step.
    virtual void abandon_step() = 0;

    /// Discards the state of earlier steps.
    virtual void forget() = 0;

    /// See ActiveSetEnergy.
    virtual DeviceActiveSet* on_device([[maybe_unused]] const CudaSpace& space) { return nullptr; }
};

/// Rules of a step, without their tables.
ContactRules rules_of(const StepStart& start, const ContactTerms::Settings& settings);

/// Rules of a step's projections, without their tables.
ProjectionRules projection_rules_of(const StepStart& start);

} // namespace toile::collision
