#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <unordered_map>
#include <vector>

#include "collision/contact/contact_bodies.h"
#include "collision/geometry/contact_pair.h"

namespace toile {
class CudaSpace;
} // namespace toile

namespace toile::collision {

/// Keeps cloth from crossing cloth and bodies during a step, and finds the pairs that press: of cloth with
/// cloth, and the guards of cloth near bodies.
///
/// Pairs are found once, for the expected motion of the step. They serve until the cloth is limited or has
/// slid from where they were found; then they are searched for again from its new position.
class ClothContact {
public:
    /// Returns [vertices] 1 for cloth on a body that advects it; called when trajectories are limited.
    using FindSupported = std::function<std::vector<unsigned char>()>;

    explicit ClothContact(ContactSoup soup);
    virtual ~ClothContact() = default;
    ClothContact(const ClothContact&) = delete;
    ClothContact& operator=(const ClothContact&) = delete;

    ContactBodies& bodies() { return bodies_; }
    const ContactBodies& bodies() const { return bodies_; }

    /// Finds the pairs for a step from start.x to about start.prediction, or begins that search. Fields are
    /// borrowed during the step.
    virtual void begin_step(const StepStart& start, NearbyBodies& near) = 0;
    /// [vertices] where cloth stands, carried along, when the bodies have arrived at t1: the start of all its
    /// trajectories in the step, on the machine that makes it [m]. Empty if no body moves. Valid after
    /// begin_step(), until the next search.
    virtual View<const Vec3> carried() const = 0;
    /// Waits for the search that begin_step() has begun, before any other call.
    virtual void end_search() {}

    /// Appends the pairs that may press in this step.
    virtual void append_pairs(std::vector<ContactPair>& out) const = 0;
    /// Pairs of append_pairs() on the device, until the next search; empty on the CPU.
    virtual View<const ContactPair> pressing_on_device() const { return {}; }
    /// Pairs with colliders that make no term, with fields of the machine that makes the step.
    virtual ReplacedPairs replaced() const = 0;

    /// True if no cloth was expected near cloth or bodies when pairs were found: none of it presses, and what
    /// an unfinished minimisation reaches need not be looked at.
    virtual bool is_clear() const = 0;

    /// Limits x where cloth would cross. Searches again from there if the correction is large, a pair stops
    /// cloth for the first or third time in the step or pressing pairs have slid. True if there are new
    /// pairs.
    virtual bool advance(StepField x, const FindSupported& find_supported) = 0;
    bool has_limited() const { return has_limited_; } ///< x in the last advance() or limit_motion()

    /// Limits x where cloth would cross, and removes the velocity of the correction from v, for a step of dt
    /// [s]. True if the correction was large: x may go on from there, and be limited again.
    virtual bool limit_motion(StepField x, StepField v, double dt, const FindSupported& find_supported) = 0;

    /// See ExemptPairs. @param crosses  [vertices] of cloth
    void set_crossing(View<const unsigned char> crosses);

    /// Updates the deviation of the cloth from its prediction.
    virtual void end_step(StepField x) = 0;

    /// Goes back to before begin_step().
    virtual void abandon_step() = 0;

    /// Discards the state of earlier steps, for cloth that was moved elsewhere.
    virtual void forget();

    PairThickness thickness() const { return rules_.thickness(); } ///< on the host

protected:
    const ContactSoup& soup() const { return soup_; }
    const ClothContactRules& rules() const { return rules_; }
    const ExemptPairs& exempt() const { return exempt_; }
    View<const unsigned char> fixed() const { return fixed_; } ///< [vertices of the soup]
    /// Begins a step: nothing has been stopped.
    void begin(View<const unsigned char> fixed_cloth);

    /// [vertices] 1: of a pair that has stopped cloth in this step; empty: none has.
    View<const unsigned char> stopped() const
    {
        return has_stopped_ ? stopped_ : View<const unsigned char>();
    }
    /// @param blocked  pairs that limit x
    void mark_stopped(View<const BlockedPair> blocked);
    /// True if some of the last of them are new, or have stopped cloth again and again.
    bool stops_more() const { return stops_more_; }

private:
    ContactSoup soup_;
    ClothContactRules rules_;
    ExemptPairs exempt_;
    ContactBodies bodies_;
    std::vector<unsigned char> fixed_;
    bool has_limited_ = false, has_stopped_ = false, stops_more_ = false;
    std::vector<unsigned char> stopped_;                   ///< [vertices of the soup]
    std::unordered_map<std::uint64_t, int> times_blocked_; ///< pairs of this step, by their primitives
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
