#pragma once

#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace toile::avatars {

/// Plane with two axes in it: u, v and the normal are right-handed and of unit length.
struct SectionPlane {
    Vec3 point = Vec3::Zero();
    Vec3 normal = Vec3::UnitY();
    Vec3 u = Vec3::UnitZ();
    Vec3 v = Vec3::UnitX();

    /// @param normal  any length above 0
    static SectionPlane through(const Vec3& point, const Vec3& normal);

    Vec2 project(const Vec3& x) const { return {u.dot(x - point), v.dot(x - point)}; }
    Vec3 lift(const Vec2& x) const { return point + x.x() * u + x.y() * v; }
};

/// Closed curve in which a plane cuts a surface.
struct SectionLoop {
    std::vector<Vec3> points; ///< [3 or more] around the curve [m]
    /// [points] that lie between each point and the next; -1: the chord of a curve that ends at a border.
    /// Empty for a loop that was not cut.
    std::vector<int> triangles;
    Vec3 center = Vec3::Zero(); ///< of the enclosed area [m]
    double area = 0.0;          ///< [m^2] not negative
    Bounds box{};

    bool is_closed() const { return triangles.empty() || triangles.back() >= 0; }
    double width(int axis) const { return box.upper[axis] - box.lower[axis]; }
};

/// Curves in which the plane cuts the surface, largest area first. Curves that end at a border of the surface
/// are closed by a chord; those of fewer than three points are left out. O(triangles).
std::vector<SectionLoop> cut(const TriangleMesh& mesh, const SectionPlane& plane);

/// The closed curve through points of the plane.
SectionLoop loop_through(std::vector<Vec3> points, const SectionPlane& plane);

/// Convex hull of the points, projected onto the plane. [corners x 3]
std::vector<Vec3> convex_hull(View<const Vec3> points, const SectionPlane& plane);

/// Length of the closed line through the points [m].
double closed_length(View<const Vec3> points);

/// Length of the open line through the points [m].
double open_length(View<const Vec3> points);

} // namespace toile::avatars
