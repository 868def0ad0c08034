#pragma once

#include <vector>

#include "collision/collider_pairs_kernels.h"
#include "collision/detect.h"
#include "core/pd/active_set_energy.h"

namespace toile {

/// The places during a step where cloth is near avatars and shapes. All are found at its start, around where
/// the cloth is taken along by what it is near to; later only those of cloth that has strayed.
class ColliderPairs {
public:
    /// Fastest surface that cloth is carried along with [m/s]. A body that jumps further in a step has been
    /// replaced, not moved: taking cloth along would shoot it away.
    static constexpr double kMaxCarrySpeed = 20.0;

    struct Settings {
        double gap = 0.0;        ///< [m] the largest that any cloth is to keep
        bool face_vertex = true; ///< see DetectSettings
        bool edge_edge = true;
    };

    /// @param triangles  [triangles] of all cloths
    /// @param positions  [vertices] start positions [m]
    /// @param partners   their numbers are those of the pairs
    ColliderPairs(View<const Triangle> triangles, View<const Vec3> positions,
                  std::vector<ContactPartner> partners, const Settings& settings);
    ColliderPairs(const ColliderPairs&) = delete;
    ColliderPairs& operator=(const ColliderPairs&) = delete;

    /// All pairs at the start of a step.
    void find(const StepStart& start);

    /// Marks the vertices that may touch a mesh at x where nobody has looked. True when there are any.
    /// @param x       [vertices] where the cloth has come to [m]
    /// @param strays  [vertices] set to 1
    bool mark_unseen(View<const Vec3> x, View<unsigned char> strays);

    /// The pairs of marked vertices with meshes again, and all with shapes, at the same time, from x
    /// [vertices] [m]. Where nothing is marked all stay as they are.
    void find_again(View<const Vec3> x, View<const unsigned char> strays);

    /// Remembers which sides of moving meshes the cloth is on at the end of a step.
    void learn_sides(View<const Vec3> x);

    /// Drops what earlier steps left.
    void forget();

    bool empty() const { return partners_.empty(); }
    const std::vector<ContactPair>& all() const { return pairs_; }

    /// [vertices] where the pairs of each were looked for [m]
    View<const Vec3> found_at() const { return found_at_; }

private:
    void carry(View<const Vec3> x);
    void look(View<const Vec3> x);
    void take_nearest();

    std::vector<ContactPartner> partners_;
    Settings settings_;
    ContactDetector detector_;
    SideMemory sides_;             ///< of moving meshes
    double farthest_motion_ = 0.0; ///< [m] in the step, of a surface that takes cloth along

    std::vector<ContactPair> pairs_;
    std::vector<Vec3> found_at_; ///< [vertices] [m]
    std::vector<double> reach_;  ///< [vertices] how near to found_at_ was looked [m]
    std::vector<double> wanted_; ///< [vertices] the same where it is to be looked, elsewhere kNowhere [m]
    std::vector<NearestSurface> nearest_; ///< [vertices] last step's
};

/// What takes cloth along; pose and motion of a mesh are left to who has them.
CarryingPartner carrying(const ContactPartner& partner);

} // namespace toile
