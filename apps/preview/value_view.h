#pragma once

#include <vector>

#include "apps/preview/camera.h"
#include "apps/preview/colour_map.h"
#include "apps/preview/image.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::preview {

/// View of a surface that is coloured by values at its vertices, among grey surfaces. The only light comes
/// from the camera and is weak, so that colours can be compared with those of a legend. Rays are traced once
/// for any number of pictures.
class ValueView {
public:
    /// @param around  drawn grey; may be empty
    ValueView(const TriangleMesh& surface, const TriangleMesh& around, const Camera& camera, int width,
              int height);

    /// @param values  [vertices of the surface] finite
    Image picture(View<const double> values, const ColourScale& scale) const;

private:
    static constexpr int kNothing = -1, kAround = -2;

    /// What a ray meets.
    struct Sample {
        int triangle = kNothing;  ///< of the surface
        float u = 0.0f, v = 0.0f; ///< weights of its corners 1 and 2 [-]
        float brightness = 1.0f;  ///< [-]
    };

    Vec3 colour(const Sample& sample, View<const double> values, const ColourScale& scale) const;

    int width_, height_;
    std::vector<Triangle> triangles_;
    std::vector<Sample> samples_; ///< [pixels x rays]
};

} // namespace toile::preview
