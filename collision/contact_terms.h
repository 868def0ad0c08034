#pragma once

#include <memory>
#include <vector>

#include "collision/cloth/cloth_contact.h"
#include "collision/colliders.h"
#include "collision/contact_cloth.h"
#include "collision/contact_pushes.h"
#include "collision/contact_rules.h"
#include "core/pd/active_set_energy.h"

namespace toile {

class CudaSpace;
class DeviceActiveSet;

/// The terms of Contact during a step: made of the pairs with colliders, which it finds, and of those of
/// cloth with cloth; what they are asked; and what friction remembers of them. HostContactTerms has them on
/// the CPU, DeviceContactTerms on a GPU; the same terms in the same order.
class ContactTerms {
public:
    struct Settings {
        double stiffness = 0.0, recovery_speed = 0.0; ///< see Contact::Settings
        bool face_vertex = true, edge_edge = true;
    };

    using Slip = RememberedSlip;

    ContactTerms() = default;
    virtual ~ContactTerms() = default;
    ContactTerms(const ContactTerms&) = delete;
    ContactTerms& operator=(const ContactTerms&) = delete;

    /// Finds the pairs with colliders of a step.
    virtual void begin_step(const StepStart& start) = 0;

    /// Makes the terms of those and of the pairs of cloth with cloth, may be null. Pairs that cannot move at
    /// all make none; faces and edges with a caught vertex are left to the planes of their vertices.
    virtual void make(const ClothContact* between) = 0;

    virtual bool empty() const = 0;

    /// Positions [vertices] [m] that the functions below are about, as they are when these are called.
    virtual void see(StepField x) = 0;

    /// Sees how hard the terms press, and what friction's limits would be by that.
    virtual FrictionLimits look_at_forces() = 0;

    /// Bounds friction by what was seen.
    virtual void adopt_forces() = 0;

    /// Cloth that lies on a collider, or is in it: 1 for each such vertex.
    virtual std::vector<unsigned char> leaning() = 0;

    /// True when cloth has left the places that its pairs with colliders are good for, by more than `trust`
    /// [m] where they press: find_again() looks for theirs.
    virtual bool has_left(double trust) = 0;
    virtual void find_again() = 0;

    /// How deep a step would end in colliders [m]; 0 where it would not.
    virtual double deepest() = 0;

    // Move cloth by contact alone, term by term (contact_pushes.h).

    /// Positions to where contact would take them before a minimisation (PushToRest). False only where
    /// nothing moves.
    virtual bool push_to_rest(int sweeps) = 0;
    /// Positions out of what they are in by more than `most` [m] (PushOut).
    virtual void push_out(double most) = 0;
    /// Velocities [m/s] that go into surfaces (StopAtSurface).
    virtual void stop_at_surfaces(StepField v) = 0;
    /// Both as rigid contact with friction changes them (Rub).
    virtual void rub(StepField v) = 0;

    /// Keeps forces and sticking of the pairs that press, for their successors. The forces are the
    /// minimiser's: clearing and the strain limit move cloth afterwards, out of pairs to the last bit.
    virtual void remember(Slip slip) = 0;
    virtual int remembered() const = 0; ///< pairs

    /// Remembers which sides of colliders the cloth is on. Returns the smallest distance of a pair [m]; 0
    /// where there is none.
    virtual double end_step() = 0;

    /// Drops what earlier steps left.
    virtual void forget() = 0;

    /// See ActiveSetEnergy.
    virtual DeviceActiveSet* on_device([[maybe_unused]] const CudaSpace& space) { return nullptr; }
};

/// The rules of a step, without their tables.
ContactRules rules_of(const StepStart& start, const ContactTerms::Settings& settings);

/// Those of its pushes, without their tables.
PushRules push_rules_of(const StepStart& start);

} // namespace toile
