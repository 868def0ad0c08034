#pragma once

#include <memory>
#include <vector>

#include "collision/surface_proximity.h"
#include "scenes/scene_body.h"

namespace toile {

/// How deep cloth lies inside the avatars of a scene, frame by frame.
class PenetrationMeter {
public:
    explicit PenetrationMeter(const Scene& scene);

    /// Shows the avatars at time t [s].
    void advance_to(double t);

    /// Largest depth of a vertex or triangle centre below the surface of any avatar [m]; 0 when nothing is
    /// inside. Points that are not finite are left out.
    double deepest(View<const Vec3> x, const std::vector<Triangle>& triangles) const;

private:
    double depth(const Vec3& point) const;

    std::vector<SceneBody> bodies_;
    std::vector<std::unique_ptr<SurfaceProximity>> surfaces_; ///< [bodies] null for shapes
};

} // namespace toile
