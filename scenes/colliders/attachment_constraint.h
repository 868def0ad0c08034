#pragma once

#include <array>
#include <vector>

#include "scenes/colliders/collider.h"

namespace toile::scenes {

/// An attachment of a running scene: its vertices and their targets over time.
class AttachmentConstraint {
public:
    /// Selects vertices by their start positions and attaches them to the world or to a collider's surface.
    /// @param location  named in errors, e.g. "tablecloth.json: attachments[0]"
    /// @throws InvalidInput if it selects no vertex, an index is out of range, or the avatar is too far away.
    AttachmentConstraint(const scene::Attachment& settings, View<const Vec3> start,
                         const std::vector<Collider>& colliders, const std::string& location);

    const std::vector<int>& vertices() const { return vertices_; }
    std::optional<double> stiffness() const { return settings_.stiffness; }
    bool is_active_at(double t) const { return !settings_.release || t < *settings_.release; }

    /// True if the targets move at time t [s] or the vertices are released then: cloth must not sleep.
    bool changes_at(double t) const { return !motion_.is_static() || !is_active_at(t); }

    /// Advances the targets to time t [s], at which the attachment is active. Colliders are already advanced.
    void follow(double t, const std::vector<Collider>& colliders);

    /// Target of the k-th attached vertex at the time of follow() [m].
    Vec3 target(int k) const;

private:
    /// A point in the frame of a collider's triangle.
    struct SurfaceTie {
        std::array<int, 3> corner; ///< indices into anchors_
        Vec3 barycentric;
        Vec3 offset; ///< [m] in the triangle's frame
    };

    void select(View<const Vec3> start, const std::vector<Collider>& colliders, const std::string& location);
    void tie(const Collider& collider);

    scene::Attachment settings_;
    std::vector<int> vertices_;
    std::vector<Vec3> start_; ///< [attached vertices] start positions [m]
    RigidMotion motion_;
    int collider_ = -1;
    Eigen::Isometry3d shape_from_world_ = Eigen::Isometry3d::Identity(); ///< at the start, for shapes
    std::vector<SurfaceTie> ties_;                                       ///< [attached vertices] for meshes
    std::vector<int> anchors_; ///< vertices of the collider's mesh used by ties_

    // State at the time of follow().
    Eigen::Isometry3d world_from_start_ = Eigen::Isometry3d::Identity(); ///< for the world and shapes
    std::vector<Vec3> anchored_;                                         ///< [anchors] [m]
};

} // namespace toile::scenes
