#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "collision/geometry/surface_view.h"

namespace toile::collision {

/// Closest-point queries on a triangle surface that moves without changing its triangles.
///
/// A TriangleTree only proposes triangles. Distances are computed in double and ties go to the lowest
/// triangle. Results therefore do not depend on the tree or on the number of threads.
///
/// Any triangle list is valid: self-intersecting, collapsed, non-manifold. If a feature has no normal (all
/// its triangles collapsed), the direction to the query point replaces it, with a positive sign. Queries may
/// run on any number of threads at once, update() on one.
class SurfaceProximity {
public:
    /// Builds the tree. O(n log n).
    /// @param triangles  [triangles x 3] indices into positions
    /// @param positions  [vertices x 3] [m]
    SurfaceProximity(View<const Triangle> triangles, View<const Vec3> positions);
    ~SurfaceProximity();
    SurfaceProximity(SurfaceProximity&&) noexcept;
    SurfaceProximity& operator=(SurfaceProximity&&) noexcept;

    /// Moves the vertices [vertices x 3] [m]; the tree keeps its topology and is refitted. O(n).
    void update(View<const Vec3> positions);

    /// Closest point of the surface nearer than max_distance [m] to p, or nothing. Of equally near triangles
    /// it takes the lowest, also if they share the closest edge or vertex and differ by rounding.
    /// @param hint  triangle that is probably near (e.g. a neighbour's result), or -1: accelerates the
    ///              search, never changes the result
    std::optional<SurfacePoint> closest(const Vec3& p,
                                        double max_distance = std::numeric_limits<double>::infinity(),
                                        int hint = -1) const;

    /// Local minimum of the distance from p, found by a walk over the surface. Each step goes to a touching
    /// triangle that is nearer. Other sheets are not found, however near.
    SurfacePoint closest_from(const Vec3& p, int triangle) const;

    /// All local minima of the distance from p to the surface within `radius` [m], nearest first, then by
    /// triangle: one per sheet of the surface. Replaces the content of out.
    /// @param unlike  unit vector: skips triangles whose face normal lies within kUnlikeCosine of it, which
    ///                is most of a smooth surface; zero skips none
    void local_closest(const Vec3& p, double radius, std::vector<SurfacePoint>& out,
                       const Vec3& unlike = Vec3::Zero()) const;

    /// Triangles whose distance from p is at most radius [m], ascending. Replaces the content of out.
    void triangles_within(const Vec3& p, double radius, std::vector<int>& out) const;

    /// Triangles within `radius` [m] of the segment ab and others near it, in any order, without distances.
    /// For callers with their own exact test and a result independent of the order. Replaces the content of
    /// out.
    void triangles_maybe_near(const Vec3& a, const Vec3& b, double radius, std::vector<int>& out) const;

    View<const Triangle> triangles() const;
    View<const Vec3> positions() const;
    Vec3 face_normal(int triangle) const; ///< unit, or zero for a triangle of no area
    Vec3 edge_normal(int edge) const;     ///< unit, or zero if all its triangles have no area
    Vec3 vertex_normal(int vertex) const; ///< angle-weighted; unit, or zero likewise
    const SurfaceEdges& edges() const;
    const SurfaceView& view() const; ///< of the whole surface, until the next update()

private:
    class Surface;
    std::unique_ptr<Surface> surface_;
};

} // namespace toile::collision
