#pragma once

#include <optional>
#include <vector>

#include "collision/cloth/near_pairs.h"
#include "collision/cloth/safe_step.h"
#include "collision/contact_cloth.h"
#include "collision/contact_pair.h"

namespace toile {

/// Cloth against itself and other cloth during a step: which pairs press, and that none ever crosses.
///
/// Pairs are found once, for the motion that the step is expected to make. They serve until the cloth is held
/// back or has slid away from where they were found; then it is looked again from there.
class ClothContact {
public:
    /// @param triangles  [triangles] of all cloths
    /// @param positions  [vertices] start positions, without crossings [m]
    /// @param cloths     whose vertices follow each other
    /// @param altitude   [vertices] shortest altitude of the triangles around [m]: no more than half of it is
    ///                   kept, or a fine mesh would push itself apart. Rigid ones can't.
    /// @param space      where pairs are looked for, borrowed; null: on the CPU
    ClothContact(View<const Triangle> triangles, View<const Vec3> positions,
                 const std::vector<ContactCloth>& cloths, View<const double> altitude,
                 const CudaSpace* space = nullptr);
    ClothContact(const ClothContact&) = delete;
    ClothContact& operator=(const ClothContact&) = delete;

    /// Finds the pairs for a step from x to about `prediction` [vertices] [m].
    /// @param fixed  [vertices] 1 where the position is prescribed; borrowed during the step
    void begin_step(View<const Vec3> x, View<const Vec3> prediction, View<const unsigned char> fixed);

    /// Appends the pairs that may press in this step.
    void append_pairs(std::vector<ContactPair>& out) const;

    /// Brings x back where cloth would cross, and looks again from there where that leaves much undone or
    /// where pairs that press have slid away. True when there are new pairs.
    /// @param leans  see SafeStep::limit
    bool advance(View<Vec3> x, View<const unsigned char> leans);

    /// Brings x back where cloth would cross. True when that was far: x may go on from there, and be brought
    /// back again.
    bool hold_back(View<Vec3> x, View<const unsigned char> leans);

    /// See ExemptPairs.
    void set_crossing(View<const unsigned char> crosses) { exempt_.set_crossing(crosses); }

    /// Learns how far the cloth came from what was predicted.
    void end_step(View<const Vec3> x);

    /// Drops what earlier steps left, for cloth that was put elsewhere.
    void forget();

    View<const double> half_thickness() const { return half_thickness_; } ///< [vertices] [m]

private:
    void look(View<const Vec3> x);
    void look_on(View<const Vec3> x, View<const Vec3> wanted);
    std::optional<ContactPair> pressing_pair(const NearPair& now) const;
    bool has_slid(View<const Vec3> x) const;
    double bounded_slack(double slack) const;

    double edge_;                                 ///< [m] mean
    double least_slack_ = 0.0, most_slack_ = 0.0; ///< [m]
    NearPairs near_;
    ExemptPairs exempt_;
    SafeStep safe_;
    std::vector<double> half_thickness_; ///< [vertices] [m]
    std::vector<double> slack_;          ///< [vertices] see SafeStep [m]
    double thickest_ = 0.0;              ///< [m] of the cloths
    std::vector<NearPair> pairs_;
    View<const unsigned char> fixed_;
    std::vector<Vec3> prediction_, deviation_, motion_, expected_; ///< [vertices] [m]
};

} // namespace toile
