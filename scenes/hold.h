#pragma once

#include <array>
#include <vector>

#include "scenes/obstacle.h"

namespace toile {

/// An attachment of a running scene: which vertices it holds and where they belong at a time.
class Hold {
public:
    /// Selects vertices in their start positions and ties them to the world or to an obstacle's surface.
    /// @param place  named in errors, e.g. "tablecloth.json: attachments[0]"
    /// @throws InvalidInput when it selects no vertex, an index is out of range, or the avatar is too far
    /// away.
    Hold(const scene::Attachment& settings, View<const Vec3> start, const std::vector<Obstacle>& obstacles,
         const std::string& place);

    const std::vector<int>& vertices() const { return vertices_; }
    std::optional<double> stiffness() const { return settings_.stiffness; }
    bool holds_at(double t) const { return !settings_.release || t < *settings_.release; }

    /// True when it moves at time t [s] or lets go: cloth must not sleep then.
    bool changes_at(double t) const { return !motion_.is_static() || !holds_at(t); }

    /// To time t [s] at which it holds, obstacles already advanced to it.
    void follow(double t, const std::vector<Obstacle>& obstacles);

    /// Position of the k-th held vertex at the time of follow() [m].
    Vec3 target(int k) const;

private:
    /// A point in the frame of an obstacle's triangle.
    struct SurfaceTie {
        std::array<int, 3> corner; ///< in anchors_
        Vec3 barycentric;
        Vec3 offset; ///< [m] in the triangle's frame
    };

    void select(View<const Vec3> start, const std::vector<Obstacle>& obstacles, const std::string& place);
    void tie(const Obstacle& obstacle);

    scene::Attachment settings_;
    std::vector<int> vertices_;
    std::vector<Vec3> start_; ///< [held] start positions [m]
    RigidMotion motion_;
    int obstacle_ = -1;
    Eigen::Isometry3d shape_from_world_ = Eigen::Isometry3d::Identity(); ///< at the start, for shapes
    std::vector<SurfaceTie> ties_;                                       ///< [held], for meshes
    std::vector<int> anchors_;                                           ///< vertices of the mesh in ties_

    // At the time of follow().
    Eigen::Isometry3d world_from_start_ = Eigen::Isometry3d::Identity(); ///< where tied to no mesh
    std::vector<Vec3> anchored_;                                         ///< [anchors] [m]
};

} // namespace toile
