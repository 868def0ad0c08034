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

    /// True for vertices and midpoints on the border of the cloth.
    bool is_on_border(int sample) const { return is_on_border_[sample] != 0; }

    const std::vector<Triangle>& triangles() const { return triangles_; }

private:
    std::vector<Triangle> triangles_;
    SurfaceEdges edges_;
    int vertex_count_;
    std::vector<char> is_on_border_; ///< [samples]
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
///   - surface within pinch_margin of the sample or of that point is buried, or has no room in front.
/// Open mesh: winding numbers are undefined, and neither side is the inside. A sample is inside if it is near
/// the mesh, within open_depth and not beside its border, on the other side than when it was last near. A
/// mesh turned inside out has no inside.
class PenetrationMeter {
public:
    struct Settings {
        double pinch_margin = 0.01; ///< [m]
        double room = 0.0;        ///< [m] that cloth needs between two surfaces that face each other; 0: none
        double open_depth = 0.05; ///< [m] of an open mesh: samples farther away may be on their way around it
    };

    /// Sides of an open mesh on which samples were last seen near it: 1 in front, -1 behind, 0 not near.
    using Sides = std::vector<signed char>;

    /// @param triangles  [triangles x 3]
    /// @param positions  [vertices x 3] [m]
    PenetrationMeter(View<const Triangle> triangles, View<const Vec3> positions, const Settings& settings);
    PenetrationMeter(View<const Triangle> triangles, View<const Vec3> positions)
        : PenetrationMeter(triangles, positions, Settings{})
    {
    }

    /// Sets new positions of the mesh [vertices x 3] [m]. O(n).
    void move(View<const Vec3> positions);

    /// Penetration at the deepest sample of [n x 3] [m]; of equally deep ones the first. Samples that are not
    /// finite are skipped.
    /// @param sides  of the same samples, kept between frames; null: an open mesh then has no inside
    Penetration measure(View<const Vec3> samples, Sides* sides = nullptr) const;

    /// True if the outside of a triangle is inside another part of a closed mesh, at its centroid or near a
    /// corner. Always false for an open mesh.
    bool is_buried(int triangle) const;

    /// True if another surface that faces the triangle is nearer than the room.
    bool is_narrow(int triangle) const;

    /// True near surface that is buried, has no room in front, or is marked.
    /// @param marked  [triangles]; empty: none
    bool is_pinched(const Vec3& point, View<const char> marked) const;

    bool is_closed() const { return is_closed_; }
    const SurfaceProximity& surface() const { return surface_; }
    const RayScene& rays() const { return rays_; } ///< of the mesh alone

private:
    struct Inside;
    std::vector<Inside> find_inside(View<const Vec3> samples) const;
    std::vector<Inside> find_beyond(View<const Vec3> samples, Sides& sides) const;
    void exclude_pinched(std::vector<Inside>& inside) const;
    bool is_on_border(const SurfacePoint& at) const;

    Settings settings_;
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
