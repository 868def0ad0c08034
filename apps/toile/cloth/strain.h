#pragma once

#include <vector>

#include "core/mesh/obj.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::app {

/// Strain of a cloth relative to its rest surface, measured without any code of the solver.
class StrainMeter {
public:
    /// @param rest       [vertices] unstretched positions in space [m]; only lengths matter
    /// @param triangles  [triangles] each of positive area
    StrainMeter(View<const Vec3> rest, std::vector<Triangle> triangles);
    /// @param panels     [triangles] unstretched corners of each in its panel [m]
    StrainMeter(const std::vector<FlatTriangle>& panels, std::vector<Triangle> triangles);

    double rest_area() const { return rest_area_; } ///< [m^2]

    /// Principal stretches of a triangle [-]: both are 1 at rest.
    struct Stretches {
        double larger, smaller;
    };
    Stretches stretches(View<const Vec3> x, int triangle) const;

    int triangle_count() const { return int(triangles_.size()); }
    double rest_area(int triangle) const; ///< [m^2]

    /// Maximum principal stretch minus one [-]; 0 for a mesh at rest, -1 for a point or no triangle.
    struct Largest {
        double of_free = -1.0;
        double of_attached = -1.0; ///< of triangles with three attached vertices
        int free_triangle = -1;    ///< that of of_free
    };

    /// @param attached  [vertices] nonzero for attached ones
    Largest largest(View<const Vec3> x, View<const unsigned char> attached) const;

private:
    void add(const Vec3& e1, const Vec3& e2);

    std::vector<Triangle> triangles_;
    std::vector<Mat2>
        inverse_rest_; ///< [triangles] of the edges x1 - x0, x2 - x0 in the triangle's plane [1/m]
    double rest_area_ = 0.0;
};

} // namespace toile::app
