#pragma once

#include <string>
#include <vector>

#include "collision/bvh/ray_scene.h"
#include "collision/geometry/shapes.h"
#include "collision/geometry/surface_proximity.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::collision {

/// Sample points of a whole cloth: its vertices, then the centroids of its triangles, then the midpoints of
/// its edges. Vertices alone miss a coarse face that a knee has pierced.
class ClothSamples {
public:
    /// @param triangles  [triangles x 3]
    ClothSamples(View<const Triangle> triangles, int vertex_count);

    /// Samples at cloth positions x [vertices x 3] [m].
    std::vector<Vec3> at(View<const Vec3> x) const;

    /// Name of a sample: "vertex 12", "triangle 7" or "edge 3-12".
    std::string name(int sample) const;

private:
    std::vector<Triangle> triangles_;
    SurfaceEdges edges_;
    int vertex_count_;
};

/// Depth of cloth inside a collider.
struct Penetration {
    double max_depth = 0.0;        ///< [m] 0 if nothing is inside
    int sample = -1;               ///< index of the deepest sample, or -1
    Vec3 point = Vec3::Zero();     ///< position of that sample [m]
    int excluded_count = 0;        ///< excluded samples inside (see PenetrationMeter)
    double deepest_excluded = 0.0; ///< [m] 0 if none
};

/// Measures cloth inside a triangle mesh to certify results; independent of contact detection.
///
/// Closed mesh: a sample is inside if the mesh winds around it (ray crossings); its depth is the distance to
/// the nearest surface. A body in motion intersects itself, and then no side is right: cloth pinched in an
/// armpit is inside one part or the other. A sample is therefore excluded, and counted as such, if
///   - the mesh winds around it more than once,
///   - its nearest surface point is buried in another part of the body, or
///   - surface within self_intersection_margin of the sample or of that point is buried.
/// Open mesh: winding numbers are undefined. The pseudo-normal defines behind, down to open_depth and not
/// beyond the border. A mesh turned inside out has no inside.
class PenetrationMeter {
public:
    struct Settings {
        double self_intersection_margin = 0.01; ///< [m]
        double open_depth = 0.05;               ///< [m] deeper points behind an open mesh do not count
    };

    /// @param triangles  [triangles x 3]
    /// @param positions  [vertices x 3] [m]
    PenetrationMeter(View<const Triangle> triangles, View<const Vec3> positions);

    /// Sets new positions of the mesh [vertices x 3] [m]. O(n).
    void move(View<const Vec3> positions);

    /// Penetration at the deepest sample of [n x 3] [m]; of equally deep ones the first. Samples that are not
    /// finite are skipped.
    Penetration measure(View<const Vec3> samples, const Settings& settings) const;
    Penetration measure(View<const Vec3> samples) const { return measure(samples, Settings{}); }

    /// True if the outside of a triangle is inside another part of a closed mesh, at its centroid or near a
    /// corner. Always false for an open mesh.
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

/// Maximum depth [m] of any point of triangle (a, b, c) in a convex solid, to 1e-7 m; 0 if the whole triangle
/// is outside. Corners must be finite.
/// @param pose  world_from_shape
double penetration_of_triangle(const Shape& shape, const Eigen::Isometry3d& pose, const Vec3& a,
                               const Vec3& b, const Vec3& c);

} // namespace toile::collision
