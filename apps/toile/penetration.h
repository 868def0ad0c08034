#pragma once

#include <memory>
#include <vector>

#include "collision/penetration.h"
#include "scenes/scene_body.h"

namespace toile {

/// How deep cloth lies inside the avatars of a scene, frame by frame.
class ScenePenetration {
public:
    explicit ScenePenetration(const Scene& scene);

    /// Shows the avatars at time t [s].
    void advance_to(double t);

    /// The avatars at the time shown.
    const std::vector<SceneBody>& bodies() const { return bodies_; }

    /// Of a mesh avatar; null for planes, spheres, capsules and boxes.
    const PenetrationMeter* meter(int body) const { return meters_[size_t(body)].get(); }

    /// Largest depths below the surface of any avatar [m].
    struct Depth {
        double deepest = 0.0;
        double excluded = 0.0; ///< where a mesh intersects itself (PenetrationMeter)
    };

    /// In planes, spheres, capsules and boxes of any point of the cloth, in meshes of the cloth's samples.
    /// Points that are not finite are left out.
    /// @param x        [vertices] of the cloth [m]
    /// @param samples  of the cloth with these triangles
    Depth measure(View<const Vec3> x, View<const Triangle> triangles, const ClothSamples& samples) const;

private:
    std::vector<SceneBody> bodies_;
    std::vector<std::unique_ptr<PenetrationMeter>> meters_; ///< [bodies] null for shapes
};

} // namespace toile
