#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "collision/cloth/cloth_contact_rules.h"
#include "collision/contact_pair.h"
#include "core/pd/active_set_energy.h"

namespace toile {

class CudaSpace;

/// Cloth against itself and other cloth during a step: which pairs press, and that none ever crosses.
///
/// Pairs are found once, for the motion that the step is expected to make. They serve until the cloth is held
/// back or has slid away from where they were found; then it is looked again from there.
class ClothContact {
public:
    /// [vertices] 1 where cloth lies on a body that takes it along: asked where something is brought back.
    using Leaning = std::function<std::vector<unsigned char>()>;

    explicit ClothContact(ClothContactRules rules) : rules_(std::move(rules)) {}
    virtual ~ClothContact() = default;
    ClothContact(const ClothContact&) = delete;
    ClothContact& operator=(const ClothContact&) = delete;

    /// Finds the pairs for a step from start.x to about start.prediction, or begins to; fields are borrowed
    /// during the step.
    virtual void begin_step(const StepStart& start) = 0;
    /// Waits for what begin_step() has begun, before anything else is asked.
    virtual void end_search() {}

    /// Appends the pairs that may press in this step.
    virtual void append_pairs(std::vector<ContactPair>& out) const = 0;
    /// What append_pairs() appends, on the device until it is looked again; nothing on the CPU.
    virtual View<const ContactPair> pressing_there() const { return {}; }

    /// Brings x back where cloth would cross, and looks again from there where that leaves much undone or
    /// where pairs that press have slid away. True when there are new pairs.
    virtual bool advance(StepField x, const Leaning& leans) = 0;

    /// Brings x back where cloth would cross: what is held back loses the velocity v that it was to have got
    /// there by in the step of dt [s]. True when that was far: x may go on from there, and be brought back
    /// again.
    virtual bool hold_back(StepField x, StepField v, double dt, const Leaning& leans) = 0;

    /// See ExemptPairs.
    virtual void set_crossing(View<const unsigned char> crosses) = 0;

    /// Learns how far the cloth came from what was predicted.
    virtual void end_step(StepField x) = 0;

    /// Drops what earlier steps left, for cloth that was put elsewhere.
    virtual void forget() = 0;

    PairThickness thickness() const { return rules_.thickness(); } ///< of the host

protected:
    const ClothContactRules& rules() const { return rules_; }

private:
    ClothContactRules rules_;
};

/// @param triangles  [triangles] of all cloths
/// @param positions  [vertices] start positions, without crossings [m]
/// @param cloths     whose vertices follow each other
/// @param altitude   [vertices] shortest altitude of the triangles around [m]
/// @param space      where pairs are looked for and looked at, borrowed, and the steps are made there; null:
///                   on the CPU
std::unique_ptr<ClothContact> make_cloth_contact(View<const Triangle> triangles, View<const Vec3> positions,
                                                 const std::vector<ContactCloth>& cloths,
                                                 View<const double> altitude, const CudaSpace* space);

} // namespace toile
