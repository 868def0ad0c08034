#pragma once

#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace toile::app {

/// Strain of a cloth relative to its rest surface, measured without any code of the solver.
class StrainMeter {
public:
    /// @param rest       [vertices] unstretched positions in space [m]; only lengths matter
    /// @param triangles  [triangles] each of positive area
    StrainMeter(View<const Vec3> rest, std::vector<Triangle> triangles);

    /// Maximum principal stretch minus one [-]; 0 for a mesh at rest, -1 for a point or no triangle.
    struct Largest {
        double of_free = -1.0;
        double of_attached = -1.0; ///< of triangles with three attached vertices
    };

    /// @param attached  [vertices] nonzero for attached ones
    Largest largest(View<const Vec3> x, View<const unsigned char> attached) const;

private:
    std::vector<Triangle> triangles_;
    std::vector<Mat2>
        inverse_rest_; ///< [triangles] of the edges x1 - x0, x2 - x0 in the triangle's plane [1/m]
};

} // namespace toile::app
