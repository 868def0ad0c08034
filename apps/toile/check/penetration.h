#pragma once

#include <memory>
#include <vector>

#include "collision/check/passages.h"
#include "collision/check/penetration.h"
#include "scenes/colliders/scene_body.h"

namespace toile::app {

/// Cloth that passed through an avatar between two frames.
struct AvatarPassage {
    int cloth, body;
    collision::Passage passage;
};

/// Penetration of cloth in the avatars of a scene, frame by frame.
class ScenePenetration {
public:
    explicit ScenePenetration(const scenes::Scene& scene);

    /// Poses the avatars at time t [s].
    /// @param cloths  from the time of the last pose to t, all finite
    /// @return cloth that passed through them in between
    std::vector<AvatarPassage> advance_to(double t, const std::vector<collision::ClothFrames>& cloths);

    /// Avatars at the current time.
    const std::vector<scenes::SceneBody>& bodies() const { return bodies_; }

    /// Meter of a mesh avatar; null for planes, spheres, capsules and boxes.
    const collision::PenetrationMeter* meter(int body) const { return meters_[size_t(body)].get(); }

    /// Maximum depths below the surface of any avatar [m].
    struct Depth {
        double deepest = 0.0;
        Vec3 point = Vec3::Zero(); ///< of the cloth at `deepest` [m]
        double pinched = 0.0;      ///< where parts of a mesh leave no room (PenetrationMeter)
    };

    /// Depth of the cloth's vertices in planes, spheres, capsules and boxes, of its samples in meshes.
    /// Non-finite points are skipped.
    /// @param x        [vertices] of the cloth [m]
    /// @param samples  of the cloth with these triangles
    /// @param sides    [bodies] of this cloth, kept between frames
    Depth measure(View<const Vec3> x, View<const Triangle> triangles, const collision::ClothSamples& samples,
                  std::vector<collision::PenetrationMeter::Sides>& sides) const;

private:
    std::vector<scenes::SceneBody> bodies_;
    std::vector<std::unique_ptr<collision::PenetrationMeter>> meters_; ///< [bodies] null for shapes
};

} // namespace toile::app
