#pragma once

#include <vector>

#include "apps/preview/camera.h"
#include "apps/preview/image.h"
#include "apps/preview/lighting.h"
#include "apps/preview/render_scene.h"
#include "collision/bvh/ray_scene.h"

namespace toile::preview {

struct RenderSettings {
    int width = 960;           ///< [pixels]
    int height = 720;          ///< [pixels]
    int samples = 16;          ///< per pixel; powers of two are best distributed
    bool removes_noise = true; ///< by remove_noise()
};

/// Renders preview pictures of surfaces: ray-traced soft sun, sky with ambient occlusion and one bounce, a
/// floor that fades into a light background. Noise of few samples is removed. The result has the same bits
/// for any number of threads.
class Renderer {
public:
    /// Copies the scene and builds its ray tree.
    /// @throws InvalidInput for settings out of range, a triangle out of range, a print without
    ///         corner_coordinates.
    Renderer(RenderScene scene, RenderSettings settings);

    /// Moves a mesh to the next frame and updates normals and tree, O(vertices).
    /// @throws InvalidInput if the vertex count differs.
    void update(int mesh, View<const Vec3> positions);

    Image render(const Camera& camera) const;

    /// All vertices of the current frame, for fit_camera.
    std::vector<Vec3> points() const;

private:
    RenderScene scene_;
    RenderSettings settings_;
    std::vector<std::vector<Vec3>> normals_; ///< [meshes][vertices]
    collision::RayScene rays_;
};

} // namespace toile::preview
