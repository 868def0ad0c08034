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

    /// Maximum principal stretch over all triangles minus one [-]; 0 for a mesh at rest, -1 for a point.
    double largest(View<const Vec3> x) const;

private:
    std::vector<Triangle> triangles_;
    std::vector<Mat2>
        inverse_rest_; ///< [triangles] of the edges x1 - x0, x2 - x0 in the triangle's plane [1/m]
};

} // namespace toile::app
