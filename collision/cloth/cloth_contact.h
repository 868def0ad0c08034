#pragma once

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
    ClothContact(View<const Triangle> triangles, View<const Vec3> positions,
                 const std::vector<ContactCloth>& cloths, View<const double> altitude);

    /// Finds the pairs for a step from x to about `prediction` [vertices] [m].
    void begin_step(View<const Vec3> x, View<const Vec3> prediction);

    /// Appends the pairs that may press in this step.
    void append_pairs(std::vector<ContactPair>& out) const;

    /// Brings x back where cloth would cross, and looks again from there where that leaves much undone or
    /// where pairs that press have slid away. True when there are new pairs.
    bool advance(View<Vec3> x);

    /// Brings x back where cloth would cross; what is undone stays undone. True when anything moved.
    bool hold_back(View<Vec3> x);

    /// Learns how far the cloth came from what was predicted.
    void end_step(View<const Vec3> x);

    /// Drops what earlier steps left, for cloth that was put elsewhere.
    void forget();

    /// Between the middle surfaces of a pair [m].
    double thickness_of(const ContactPair& pair) const;
    int cloth_of(int vertex) const { return cloth_[vertex]; }
    int near_count() const { return int(pairs_.size()); }

private:
    double thickness_of(const std::array<int, 4>& vertex, int first_count) const;
    void look(View<const Vec3> x);
    bool has_slid(View<const Vec3> x) const;
    double bounded_slack(double slack) const;

    NearPairs near_;
    SafeStep safe_;
    std::vector<int> cloth_;             ///< [vertices]
    std::vector<double> half_thickness_; ///< [vertices] [m]
    std::vector<double> slack_;          ///< [vertices] see SafeStep [m]
    double thickest_ = 0.0, edge_ = 0.0; ///< [m] largest thickness, mean edge
    std::vector<NearPair> pairs_;
    std::vector<Vec3> prediction_, deviation_, motion_; ///< [vertices] [m]
};

} // namespace toile
