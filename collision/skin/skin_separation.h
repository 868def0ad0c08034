#pragma once

#include <vector>

#include "collision/bvh/ray_scene.h"

namespace toile::collision {

/// Moves skin that touches or enters other skin of the same body inwards, until cloth fits in between.
///
/// Arms enter the chest and thighs each other in most animations, because skinning knows no contact. Every
/// vertex has a direction into its limb; how far it moves along it, its inset, is the smallest field that
///   * leaves the clearance between surfaces that face each other, or what the rest pose has of it,
///   * makes no triangle cross another,
///   * changes by at most kSlope per distance on the surface, so that skin stays smooth.
/// An inset is at most kMaxInset and 0.3 of the thickness of the limb; what is left then stays as it is. The
/// insets depend on the pose alone.
class SkinSeparation {
public:
    static constexpr double kMaxInset = 0.02; ///< [m]
    static constexpr double kSlope = 0.5;     ///< [-]

    /// @param triangles  [triangles] of the body
    /// @param rest       [vertices] pose in which the body is as it should be [m]
    /// @param clearance  [m] between surfaces, for cloth
    SkinSeparation(std::vector<Triangle> triangles, std::vector<Vec3> rest, double clearance);

    /// Unit directions into the body at rest: normals, averaged over some rings. [vertices]
    const std::vector<Vec3>& inward() const { return inward_; }

    /// Insets of a pose. One call of stage "collision/skin_separation".
    /// @param x       [vertices] of the pose [m]
    /// @param inward  [vertices] unit directions into the body, of the pose
    /// @return [vertices] [m]
    std::vector<double> insets(View<const Vec3> x, View<const Vec3> inward);

private:
    struct Pose;
    struct Facing;

    void make_room(Pose& pose);
    Facing facing_at(const Pose& pose, int v, const Vec3& normal) const;
    Facing in_front(const Pose& pose, int v, const Vec3& normal) const;
    Facing behind(const Pose& pose, int v, const Vec3& normal) const;
    Facing beside(const Pose& pose, int v, const Vec3& normal, const RayHit& hit, double distance) const;
    void uncross(Pose& pose);
    std::vector<Triangle> triangles_near(const Pose& pose) const;
    bool raise(Pose& pose, const std::vector<double>& wanted) const;

    std::vector<Triangle> triangles_;
    std::vector<Vec3> rest_;
    double clearance_;
    std::vector<Vec3> inward_;
    std::vector<double> max_inset_;            ///< [vertices]
    std::vector<std::vector<int>> neighbours_; ///< [vertices] by edges
    RayScene rays_;
};

} // namespace toile::collision
