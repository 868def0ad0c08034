#pragma once

#include <vector>

#include "collision/body/collider_pairs_kernels.h"
#include "collision/body/detect.h"
#include "core/pd/energy/active_set_energy.h"

namespace toile::collision {

/// Contact pairs of a step between cloth and colliders. All pairs are found at the start of the step, around
/// positions advected with the nearby colliders. Later searches cover out-of-bounds vertices only.
class ColliderPairs {
public:
    /// Maximum speed of a surface that advects cloth [m/s]. A faster body has been replaced, not moved;
    /// advection would shoot the cloth away.
    static constexpr double kMaxAdvectionSpeed = 20.0;

    struct Settings {
        double gap = 0.0;        ///< [m] maximum contact thickness of any cloth
        bool face_vertex = true; ///< see DetectSettings
        bool edge_edge = true;
    };

    /// @param triangles  [triangles] of all cloths
    /// @param positions  [vertices] start positions [m]
    /// @param colliders  their indices are the pairs' collider numbers
    ColliderPairs(View<const Triangle> triangles, View<const Vec3> positions,
                  std::vector<ContactCollider> colliders, const Settings& settings);
    ColliderPairs(const ColliderPairs&) = delete;
    ColliderPairs& operator=(const ColliderPairs&) = delete;

    /// Returns the positions at t0 advected with the nearest surfaces [vertices] [m].
    View<const Vec3> advect(const StepStart& start);

    /// Finds all pairs at the start of a step.
    /// @param from  [vertices] positions around which they are searched for [m]; empty: advect()
    void find(const StepStart& start, View<const Vec3> from = {});

    /// Marks vertices that may be in contact with a mesh outside the region searched for them. True if there
    /// are any.
    /// @param x              [vertices] current cloth positions [m]
    /// @param out_of_bounds  [vertices] set to 1
    bool mark_unseen(View<const Vec3> x, View<unsigned char> out_of_bounds);

    /// Searches again at positions x [vertices] [m], without advection: marked vertices against meshes, all
    /// against shapes. Without marked vertices all pairs stay.
    void find_again(View<const Vec3> x, View<const unsigned char> out_of_bounds);

    /// Records on which sides of moving meshes the cloth is at the end of a step.
    void update_sides(View<const Vec3> x);

    /// Drops the state of earlier steps.
    void forget();

    bool empty() const { return colliders_.empty(); }
    const std::vector<ContactPair>& all() const { return pairs_; }

    View<const NearestSurface> nearest() const { return nearest_; } ///< [vertices] of the last search

    /// [vertices] Positions around which pairs were searched [m].
    View<const Vec3> found_at() const { return found_at_; }

private:
    void search(View<const Vec3> x);
    void take_nearest();

    std::vector<ContactCollider> colliders_;
    Settings settings_;
    ContactDetector detector_;
    ContactSideHistory sides_;  ///< of moving meshes
    double max_motion_ = 0.0;   ///< [m] maximum motion in the step of a surface that advects cloth
    double shape_radius_ = 0.0; ///< [m] of searches of shapes in the step

    std::vector<ContactPair> pairs_;
    std::vector<Vec3> found_at_;          ///< [vertices] [m]
    std::vector<double> reach_;           ///< [vertices] search radius around found_at_ [m]
    std::vector<double> wanted_;          ///< [vertices] radius of the next search, kNowhere to skip [m]
    std::vector<NearestSurface> nearest_; ///< [vertices] of the last step
};

/// Fills in how a collider advects cloth; the caller sets pose and motion of a mesh.
AdvectingCollider advecting_collider(const ContactCollider& collider);

} // namespace toile::collision
