#pragma once

#include <optional>
#include <vector>

#include "collision/bvh/ray_scene.h"
#include "collision/repair/body_distance.h"
#include "collision/repair/joined_cloths.h"
#include "collision/repair/repair_progress.h"
#include "collision/repair/shape_keeper.h"

namespace toile::collision {

/// Point of cloth inside a body: a vertex, the centroid of a triangle or the midpoint of an edge.
struct InsideSample {
    std::array<int, 3> vertex{-1, -1, -1}; ///< one, two or three vertices of the cloth, equally weighted
    Vec3 point = Vec3::Zero();             ///< [m]
    BodyProximity proximity;
};

/// Triangle of cloth that crosses the surface of a body.
struct SurfaceCrossing {
    int triangle;                ///< of cloth
    int body;                    ///< number of the body
    Vec3 point = Vec3::Zero();   ///< in both [m]
    Vec3 way_out = Vec3::Zero(); ///< shortest displacement that takes it off the other triangle [m]
};

/// Depth [m] above which a point counts as inside a body; at smaller depths it touches.
inline constexpr double kTouchDepth = 1e-6;

/// Moves cloth out of bodies, which are grown from where the cloth is outside.
class BodyClearing {
public:
    /// @param cloths  must outlive this, as must the bodies
    BodyClearing(const JoinedCloths& cloths, std::vector<ContactCollider> bodies);

    /// Vertices, centroids and midpoints deeper than `depth` [m] in a body, including those of fixed
    /// vertices.
    std::vector<InsideSample> inside(View<const Vec3> x, double depth) const;

    /// Vertices, ascending and not fixed, of samples that are in front of a body, or on it, but nearer than
    /// `fraction` of their gap.
    std::vector<int> nearer(View<const Vec3> x, double fraction) const;

    /// Triangles that cross or touch the surface of a body, by the exact test. Left out are faces of a body
    /// that lie inside another part of it.
    std::vector<SurfaceCrossing> crossings(View<const Vec3> x) const { return crossings(x, Which::All); }

    /// Grows the bodies: every increment advects all cloth near inside samples outwards, the deepest most and
    /// layers in their order, then relaxes it.
    void grow(View<Vec3> x, const ShapeKeeper& keeper, const RepairProgress& progress) const;

    /// Moves samples nearer to a body than their gap out to the gap, without moving cloth around them.
    void project(View<Vec3> x) const;

    /// Moves faces of cloth off body vertices that pierce them between their samples.
    void project_off_tips(View<Vec3> x) const;

    /// Pushes triangles off surfaces that they cross, by little. False if nothing moves.
    /// @param pushed  [vertices] sum of the pushes so far, bounded [m]; changed
    bool push_off_crossings(View<Vec3> x, std::vector<double>& pushed) const;

private:
    enum class Which { All, Movable };
    std::vector<SurfaceCrossing> crossings(View<const Vec3> x, Which which) const;
    void add_surface(int body, View<const Triangle> triangles, View<const Vec3> x);
    bool is_buried(int face, const Vec3& p) const;
    bool can_move(const std::array<int, 3>& vertices) const;
    InsideSample sample_at(View<const Vec3> x, int index) const;
    std::array<int, 3> corners_of(int triangle) const;
    std::vector<InsideSample> movable_below(View<const Vec3> x, double gap_fraction) const;
    template <typename Bound>
    std::vector<InsideSample> samples_below(View<const Vec3> x, const Bound& bound) const;
    void displace(View<Vec3> x, const std::vector<InsideSample>& inside, double fraction) const;

    const JoinedCloths& cloths_;
    std::vector<ContactCollider> bodies_;
    std::vector<Triangle> surface_triangles_; ///< of all bodies but planes
    std::vector<int> body_of_;                ///< [surface_triangles_]
    std::vector<Vec3> surface_x_;             ///< [vertices of all bodies] [m]
    mutable std::optional<RayScene> rays_;    ///< closed meshes, once is_buried() is asked
};

} // namespace toile::collision
