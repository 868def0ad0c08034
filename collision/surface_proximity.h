#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "collision/surface_view.h"

namespace toile {

/// Closest-point queries on a triangle surface that moves without changing its triangles.
///
/// A tree (TriangleTree) only proposes triangles; distances are computed in double, and ties go to the lowest
/// triangle, so answers do not depend on the tree or on the number of threads.
/// Any triangle list will do: self-intersecting, collapsed, non-manifold. Where a feature has no normal
/// (all its triangles collapsed) the direction to the query point stands in, with a positive sign.
/// Queries may run on any number of threads at once, update() on one.
class SurfaceProximity {
public:
    /// Builds the tree. O(n log n).
    /// @param triangles  [triangles x 3] indices into positions
    /// @param positions  [vertices x 3] [m]
    SurfaceProximity(View<const Triangle> triangles, View<const Vec3> positions);
    ~SurfaceProximity();
    SurfaceProximity(SurfaceProximity&&) noexcept;
    SurfaceProximity& operator=(SurfaceProximity&&) noexcept;

    /// Moves the vertices [vertices x 3] [m]; the tree keeps its shape and gets new boxes. O(n).
    void update(View<const Vec3> positions);

    /// The closest point of the surface nearer than max_distance [m] to p, or nothing; of equally near
    /// triangles the lowest, also where they meet in a closest edge or vertex and differ by rounding.
    /// @param hint  a triangle that is probably near (e.g. a neighbour's answer), or -1: speeds the
    ///              search up, never changes the answer
    std::optional<SurfacePoint> closest(const Vec3& p,
                                        double max_distance = std::numeric_limits<double>::infinity(),
                                        int hint = -1) const;

    /// The local minimum of the distance from p that a walk over the surface comes to: from triangle to
    /// touching triangle, always nearer. Other sheets, however near, are not seen.
    SurfacePoint closest_from(const Vec3& p, int triangle) const;

    /// Every local minimum of the distance from p to the surface within `radius` [m], nearest first, then by
    /// triangle: one for each sheet of the surface that passes by. Replaces the content of out.
    /// @param unlike  a unit vector: skips triangles whose face normal lies within kUnlikeCosine of it, which
    ///                is most of them where the surface is smooth; zero skips none
    void local_closest(const Vec3& p, double radius, std::vector<SurfacePoint>& out,
                       const Vec3& unlike = Vec3::Zero()) const;

    /// Triangles whose distance from p is at most radius [m], ascending. Replaces the content of out.
    void triangles_within(const Vec3& p, double radius, std::vector<int>& out) const;

    /// Triangles within `radius` [m] of the segment ab and others near it, in any order, without distances:
    /// for callers that test exactly themselves and whose result does not depend on the order. Replaces the
    /// content of out.
    void triangles_maybe_around(const Vec3& a, const Vec3& b, double radius, std::vector<int>& out) const;

    View<const Triangle> triangles() const;
    View<const Vec3> positions() const;
    Vec3 face_normal(int triangle) const; ///< unit, or zero for a triangle of no area
    Vec3 edge_normal(int edge) const;     ///< unit, or zero where all its triangles have no area
    Vec3 vertex_normal(int vertex) const; ///< angle-weighted; unit or zero likewise
    const SurfaceEdges& edges() const;
    const SurfaceView& view() const; ///< of all of it, until the next update()

private:
    class Surface;
    std::unique_ptr<Surface> surface_;
};

} // namespace toile
