#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "apps/toile/cloth/strain.h"
#include "collision/geometry/surface_proximity.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::app {

/// Means of the triangles around each vertex, weighted by areas.
/// @param of_triangle, area  [triangles]
/// @return [vertices]
std::vector<double> mean_at_vertices(View<const Triangle> triangles, int vertex_count,
                                     const std::vector<double>& of_triangle, const std::vector<double>& area);

/// Larger principal strain at the vertices of a cloth [-]: the mean of the triangles around, weighted by
/// their areas at rest. Stage "maps/strain".
class VertexStrain {
public:
    /// @param triangles  those of the meter
    VertexStrain(StrainMeter meter, std::vector<Triangle> triangles);

    /// @param x  [vertices] [m]
    std::vector<double> at(View<const Vec3> x) const;

private:
    StrainMeter meter_;
    std::vector<Triangle> triangles_;
    std::vector<double> areas_; ///< [triangles] at rest [m^2]
};

/// Distances from a skin, which may move. Stage "maps/gap".
class SkinDistance {
public:
    explicit SkinDistance(std::vector<Triangle> skin) : triangles_(std::move(skin)) {}

    /// Moves the skin's vertices [vertices of the skin] [m].
    void move(View<const Vec3> skin);

    /// Distances of points [points] [m], negative inside. The skin has been moved into its place.
    std::vector<double> at(View<const Vec3> x) const;

private:
    std::vector<Triangle> triangles_;
    std::optional<collision::SurfaceProximity> skin_; ///< empty before the first move()
};

} // namespace toile::app
