#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "collision/body/body_surfaces.h"
#include "collision/contact/cloth_contact_rules.h"
#include "collision/geometry/contact_pair.h"
#include "core/pd/energy/active_set_energy.h"

namespace toile {
class CudaSpace;
} // namespace toile

namespace toile::collision {

/// What contact knows of the bodies near each vertex of cloth, on the CPU.
class NearbyBodies {
public:
    virtual ~NearbyBodies() = default;
    /// [vertices] positions at t0 advected with the nearest surfaces [m]
    virtual View<const Vec3> advect(const StepStart& start) = 0;
    virtual View<const NearestSurface> nearest() const = 0; ///< [vertices] of the last step
};

/// Keeps cloth from crossing cloth and bodies during a step, and finds the pairs of cloth with cloth that
/// press. On the CPU bodies are colliders; on a GPU they are left out.
///
/// Pairs are found once, for the expected motion of the step. They serve until the cloth is limited or has
/// slid from where they were found; then they are searched for again from its new position.
class ClothContact {
public:
    /// Returns [vertices] 1 for cloth on a body that advects it; called when trajectories are limited.
    using FindSupported = std::function<std::vector<unsigned char>()>;

    explicit ClothContact(ClothContactRules rules) : rules_(std::move(rules)) {}
    virtual ~ClothContact() = default;
    ClothContact(const ClothContact&) = delete;
    ClothContact& operator=(const ClothContact&) = delete;

    /// Finds the pairs for a step from start.x to about start.prediction, or begins that search. Fields are
    /// borrowed during the step.
    virtual void begin_step(const StepStart& start, NearbyBodies& bodies) = 0;
    /// [vertices] where cloth stands, carried along, when the bodies have arrived at t1: the start of all its
    /// trajectories in the step [m]. Empty if no body moves or bodies are left out. Valid after begin_step().
    virtual View<const Vec3> carried() const { return {}; }
    /// Number of pairs in this step that bodies have closed on and that cross from now on.
    virtual int stuck_count() const { return 0; }
    virtual int first_stuck() const { return -1; } ///< a vertex of cloth of the first of them
    /// Number of vertices that let a body through (LetThrough).
    virtual int let_through_count() const { return 0; }
    virtual int first_let_through() const { return -1; }
    /// True for a pair with a collider that makes no term: its cloth lets the body through, or the pairs here
    /// know the side, which a surface without an inside does not.
    virtual bool replaces(const ContactPair&) const { return false; }
    /// Ends it where nothing crosses any more. @param crossing  all triangles of cloth that cross bodies() at
    /// t0
    virtual void close_let_through(View<const int>) {}
    /// True for a triangle of cloth that lets a body through.
    virtual bool lets_through(const Triangle&) const { return false; }
    /// Finds bodies that jump in this step of dt [s]: they stand where they have jumped to from its start.
    virtual bool have_bodies_jumped(double) { return false; }
    /// Surfaces of the bodies; null if they are left out.
    virtual const BodySurfaces* bodies() const { return nullptr; }
    /// Waits for the search that begin_step() has begun, before any other call.
    virtual void end_search() {}

    /// Appends the pairs that may press in this step.
    virtual void append_pairs(std::vector<ContactPair>& out) const = 0;
    /// Pairs of append_pairs() on the device, until the next search; empty on the CPU.
    virtual View<const ContactPair> pressing_on_device() const { return {}; }

    /// True if no cloth was expected near cloth or bodies when pairs were found: none of it presses, and what
    /// an unfinished minimisation reaches need not be looked at.
    virtual bool is_clear() const = 0;

    /// Limits x where cloth would cross. Searches again from there if the correction is large or pressing
    /// pairs have slid. True if there are new pairs.
    virtual bool advance(StepField x, const FindSupported& find_supported) = 0;

    /// Limits x where cloth would cross, and removes the velocity of the correction from v, for a step of dt
    /// [s]. True if the correction was large: x may go on from there, and be limited again.
    virtual bool limit_motion(StepField x, StepField v, double dt, const FindSupported& find_supported) = 0;

    /// See ExemptPairs. @param crossings  vertices of cloth and of bodies(), of triangles that cross
    /// @param inside  [vertices of cloth] 1: inside a body; empty: none is
    virtual void set_body_crossings(View<const std::pair<int, int>>, View<const unsigned char> /*inside*/) {}
    virtual bool lets_through(int /*vertex*/) const { return false; } ///< of cloth
    /// See ExemptPairs.
    virtual void set_crossing(View<const unsigned char> crosses) = 0;

    /// Updates the deviation of the cloth from its prediction.
    virtual void end_step(StepField x) = 0;

    /// Discards the state of earlier steps, for cloth that was moved elsewhere.
    virtual void forget() = 0;

    PairThickness thickness() const { return rules_.thickness(); } ///< on the host

protected:
    const ClothContactRules& rules() const { return rules_; }

private:
    ClothContactRules rules_;
};

/// @param triangles  [triangles] of all cloths
/// @param positions  [vertices] start positions, without crossings [m]
/// @param cloths     in the order of their vertices
/// @param altitude   [vertices] shortest altitude of the adjacent triangles [m]
/// @param colliders  bodies
/// @param cloth_with_cloth  false: with bodies alone
/// @param space      device on which pairs are searched for and tested, and steps made; borrowed. null: the
///                   CPU
/// @return null if there is nothing to keep apart
std::unique_ptr<ClothContact> make_cloth_contact(View<const Triangle> triangles, View<const Vec3> positions,
                                                 const std::vector<ContactCloth>& cloths,
                                                 View<const double> altitude,
                                                 const std::vector<ContactCollider>& colliders,
                                                 bool cloth_with_cloth, const CudaSpace* space);

} // namespace toile::collision
