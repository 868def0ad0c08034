#pragma once

#include <string>
#include <vector>

#include "collision/ray_scene.h"
#include "collision/shapes.h"
#include "collision/surface_proximity.h"
#include "core/mesh/triangle_mesh.h"

namespace toile {

/// Points that stand for a whole cloth: its vertices, then the centroids of its triangles, then the midpoints
/// of its edges. Vertices alone miss a coarse face that a knee has pierced.
class ClothSamples {
public:
    /// @param triangles  [triangles x 3]
    ClothSamples(View<const Triangle> triangles, int vertex_count);

    /// The samples at cloth positions x [vertices x 3] [m].
    std::vector<Vec3> at(View<const Vec3> x) const;

    /// "vertex 12", "triangle 7" or "edge 3-12" for a sample's index.
    std::string name(int sample) const;

private:
    std::vector<Triangle> triangles_;
    SurfaceEdges edges_;
    int vertex_count_;
};

/// How deep cloth is inside a collider.
struct Penetration {
    double max_depth = 0.0;        ///< [m] 0 when nothing is inside
    int sample = -1;               ///< index of the deepest sample, or -1
    Vec3 point = Vec3::Zero();     ///< where it is [m]
    int excluded_count = 0;        ///< samples inside that were left out (see PenetrationMeter)
    double deepest_excluded = 0.0; ///< [m] 0 when none
};

/// Measures cloth inside a triangle mesh, for certifying results: not built on the contact detection.
///
/// Closed mesh: a sample is inside when the mesh winds around it (ray crossings), its depth is the distance
/// to the nearest surface. A body in motion intersects itself, and there no side is right: cloth pinched in
/// an armpit is inside one part or the other. So a sample is excluded, and counted as such, when
///   - the mesh winds around it more than once,
///   - its nearest surface point is buried in another part of the body, or
///   - surface within self_intersection_margin of the sample or of that point is buried.
/// Open mesh: winding means nothing; behind is what the pseudo-normal says, down to open_depth, and not
/// beyond the border. A mesh turned inside out has no inside.
class PenetrationMeter {
public:
    struct Settings {
        double self_intersection_margin = 0.01; ///< [m]
        double open_depth = 0.05;               ///< [m] deeper behind an open mesh counts as elsewhere
    };

    /// @param triangles  [triangles x 3]
    /// @param positions  [vertices x 3] [m]
    PenetrationMeter(View<const Triangle> triangles, View<const Vec3> positions);

    /// New positions of the mesh [vertices x 3] [m]. O(n).
    void move(View<const Vec3> positions);

    /// The deepest of the samples [n x 3] [m]; of equally deep ones the first. Those not finite are left out.
    Penetration measure(View<const Vec3> samples, const Settings& settings) const;
    Penetration measure(View<const Vec3> samples) const { return measure(samples, Settings{}); }

    /// True when the outside of a triangle is inside another part of a closed mesh, at its centroid or near a
    /// corner. Never true of an open mesh.
    bool is_buried(int triangle) const;

private:
    struct Inside;
    std::vector<Inside> find_inside(View<const Vec3> samples) const;
    std::vector<Inside> find_behind(View<const Vec3> samples, const Settings& settings) const;
    void exclude_self_intersections(std::vector<Inside>& inside, double margin) const;
    bool is_on_border(const SurfacePoint& at) const;

    SurfaceProximity surface_;
    RayScene rays_;
    Bounds bounds_;
    bool is_closed_;
    std::vector<char> is_border_vertex_; ///< [vertices]
};

/// Depth [m] of the deepest point of triangle (a, b, c) in a convex solid, wherever in the triangle it lies,
/// to 1e-7 m; 0 when all of the triangle is outside. Finite corners only.
/// @param pose  world_from_shape
double penetration_of_triangle(const Shape& shape, const Eigen::Isometry3d& pose, const Vec3& a,
                               const Vec3& b, const Vec3& c);

} // namespace toile
