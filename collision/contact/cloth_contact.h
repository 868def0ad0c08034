#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "collision/contact/cloth_contact_rules.h"
#include "collision/geometry/contact_pair.h"
#include "core/pd/energy/active_set_energy.h"

namespace toile {
class CudaSpace;
} // namespace toile

namespace toile::collision {

/// Contact of cloth with itself and other cloth during a step: finds the pressing pairs, and prevents
/// crossings.
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
    virtual void begin_step(const StepStart& start) = 0;
    /// Waits for the search that begin_step() has begun, before any other call.
    virtual void end_search() {}

    /// Appends the pairs that may press in this step.
    virtual void append_pairs(std::vector<ContactPair>& out) const = 0;
    /// Pairs of append_pairs() on the device, until the next search; empty on the CPU.
    virtual View<const ContactPair> pressing_on_device() const { return {}; }

    /// True if no cloth was expected near other cloth when pairs were found: none of it presses, and what an
    /// unfinished minimisation reaches need not be looked at.
    virtual bool is_clear() const = 0;

    /// Limits x where cloth would cross. Searches again from there if the correction is large or pressing
    /// pairs have slid. True if there are new pairs.
    virtual bool advance(StepField x, const FindSupported& find_supported) = 0;

    /// Limits x where cloth would cross, and removes the velocity of the correction from v, for a step of dt
    /// [s]. True if the correction was large: x may go on from there, and be limited again.
    virtual bool limit_motion(StepField x, StepField v, double dt, const FindSupported& find_supported) = 0;

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
/// @param space      device on which pairs are searched for and tested, and steps made; borrowed. null: the
///                   CPU
std::unique_ptr<ClothContact> make_cloth_contact(View<const Triangle> triangles, View<const Vec3> positions,
                                                 const std::vector<ContactCloth>& cloths,
                                                 View<const double> altitude, const CudaSpace* space);

} // namespace toile::collision
