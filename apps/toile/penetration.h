#pragma once

#include <memory>
#include <vector>

#include "collision/penetration.h"
#include "scenes/scene_body.h"

namespace toile {

/// How deep one cloth lies inside the avatars of a scene, frame by frame.
class ScenePenetration {
public:
    ScenePenetration(const Scene& scene, const std::vector<Triangle>& triangles, int vertex_count);

    /// Shows the avatars at time t [s].
    void advance_to(double t);

    /// Largest depths below the surface of any avatar [m].
    struct Depth {
        double deepest = 0.0;
        double excluded = 0.0; ///< where a mesh intersects itself (PenetrationMeter)
    };

    /// In planes, spheres, capsules and boxes of any point of the cloth, in meshes of the cloth's samples.
    /// Points that are not finite are left out.
    /// @param x  [vertices] of the cloth [m]
    Depth measure(View<const Vec3> x) const;

private:
    double deepest_in(const SceneBody& solid, View<const Vec3> x) const;

    std::vector<Triangle> triangles_;
    ClothSamples samples_;
    std::vector<SceneBody> bodies_;
    std::vector<std::unique_ptr<PenetrationMeter>> meters_; ///< [bodies] null for shapes
};

} // namespace toile
