#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "collision/distance.h"
#include "collision/surface_edges.h"
#include "core/backend/types.h"

namespace toile {

/// Cosine of the angle [-] within which local_closest takes a face for more of the same sheet (30 degrees).
inline constexpr double kUnlikeCosine = 0.866;

/// A point on a triangle surface, seen from a query point p.
struct SurfacePoint {
    int triangle = -1;
    TriangleFeature feature = TriangleFeature::kFace; ///< of that triangle: where the point lies
    Vec3 barycentric = Vec3::Zero();                  ///< weights of the triangle's corners
    Vec3 point = Vec3::Zero();                        ///< [m]
    /// Unit pseudo-normal of the feature: the face's, the sum of the edge's faces', the angle-weighted sum
    /// around the vertex. It gives the right sign on a closed mesh whichever feature is closest, which no
    /// single face normal does. [Baerentzen and Aanaes 2005]
    Vec3 normal = Vec3::Zero();
    double signed_distance = 0.0; ///< [m] |p - point|, negative behind the surface: normal.(p - point) < 0

    double distance() const { return std::abs(signed_distance); }
};

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
    /// triangles the lowest.
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

private:
    class Surface;
    std::unique_ptr<Surface> surface_;
};

} // namespace toile
