#pragma once

#include <memory>
#include <vector>

#include "collision/surface_proximity.h"
#include "scenes/scene_body.h"

namespace toile {

/// How deep cloth lies inside the avatars of a scene, frame by frame.
class ScenePenetration {
public:
    explicit ScenePenetration(const Scene& scene);

    /// Shows the avatars at time t [s].
    void advance_to(double t);

    /// Largest depth below the surface of any avatar [m]; 0 when nothing is inside. In planes, spheres,
    /// capsules and boxes of any point of the cloth, in meshes of a vertex or triangle centre. Points that
    /// are not finite are left out.
    double deepest(View<const Vec3> x, const std::vector<Triangle>& triangles) const;

private:
    double depth(const Vec3& point) const;
    double depth(const Vec3& a, const Vec3& b, const Vec3& c) const;

    std::vector<SceneBody> bodies_;
    std::vector<std::unique_ptr<SurfaceProximity>> surfaces_; ///< [bodies] null for shapes
};

} // namespace toile
