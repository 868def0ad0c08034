#pragma once

#include <array>
#include <optional>
#include <vector>

#include "scenes/colliders/collider.h"
#include "scenes/colliders/skin_patch.h"

namespace toile::scenes {

/// An attachment of a running scene: its vertices and their targets over time.
class AttachmentConstraint {
public:
    /// Attaches vertices to the world or to a collider's surface. Springs to an avatar have 300 N/m a vertex
    /// by default, or as much as holds the cloth within 1 mm.
    /// @param vertices  of the cloth, ascending
    /// @param start     [vertices of the cloth] [m]
    /// @param mass  [kg] of the whole cloth, which springs hold at three times the acceleration of gravity;
    /// none: the method knows no springs, so that attachments are exact where not asked otherwise
    /// @param location  named in errors, e.g. "tablecloth.json: attachments[0]"
    AttachmentConstraint(const scene::Attachment& settings, std::vector<int> vertices, View<const Vec3> start,
                         const std::vector<Collider>& colliders, std::optional<double> mass,
                         const std::string& location);

    /// Attaches the vertices where they are. Those on an avatar are lifted so that neither they nor the edges
    /// between them are nearer to the skin than `gap` [m].
    /// @param x  [vertices of the cloth] [m]
    void tie(View<const Vec3> x, View<const Triangle> triangles, double gap,
             const std::vector<Collider>& colliders);

    /// Vertex that is farthest from the avatar to which it is attached, as of tie().
    struct Farthest {
        int vertex = -1;
        double distance = 0.0; ///< [m]
    };
    const Farthest& farthest() const { return farthest_; }
    const std::string& location() const { return location_; }
    const std::string& target_name() const { return settings_.to; }

    const std::vector<int>& vertices() const { return vertices_; }
    std::optional<double> stiffness() const { return settings_.stiffness; }
    bool is_on_avatar() const { return collider_ >= 0; }
    bool is_at_rest() const { return collider_ < 0 && settings_.keyframes.empty(); }
    bool is_active_at(double t) const { return !settings_.release || t < *settings_.release; }

    /// True if the targets move at time t [s] or the vertices are released then: cloth must not sleep.
    bool changes_at(double t) const { return !motion_.is_static() || !is_active_at(t); }

    /// Advances the targets to time t [s], at which the attachment is active. Colliders are already advanced.
    void follow(double t, const std::vector<Collider>& colliders);

    /// Target of the k-th attached vertex at the time of follow() [m].
    Vec3 target(int k) const;

private:
    void tie_to_skin(const collision::MeshCollider& mesh);
    std::vector<double> clearances(const Collider& collider, View<const Vec3> x,
                                   View<const Triangle> triangles, double gap) const;

    scene::Attachment settings_;
    std::string location_;
    std::vector<int> vertices_;
    std::vector<Vec3> start_; ///< [attached vertices] where they were tied [m]
    Farthest farthest_;
    RigidMotion motion_;
    int collider_ = -1;
    Eigen::Isometry3d shape_from_world_ = Eigen::Isometry3d::Identity(); ///< at the start, for shapes
    std::vector<SkinPatch> patches_;                                     ///< [attached vertices] for meshes
    std::vector<int> anchors_; ///< vertices of the collider's mesh used by patches_

    // State at the time of follow().
    Eigen::Isometry3d world_from_start_ = Eigen::Isometry3d::Identity(); ///< for the world and shapes
    std::vector<Vec3> anchored_;                                         ///< [anchors] [m]
};

} // namespace toile::scenes
