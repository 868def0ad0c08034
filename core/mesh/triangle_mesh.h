#pragma once

#include <string>
#include <vector>

#include "core/compute/types.h"

namespace toile {

/// Triangle surface: positions and the triangles between them.
struct TriangleMesh {
    std::vector<Vec3> positions;     ///< [vertices] [m]
    std::vector<Triangle> triangles; ///< [triangles] counter-clockwise seen from outside

    int vertex_count() const { return int(positions.size()); }
    int triangle_count() const { return int(triangles.size()); }
};

/// Surface that moves linearly in time from given start to given end positions of a step.
struct MovingMesh {
    std::vector<Triangle> triangles; ///< [triangles]
    std::vector<Vec3> x_t0;          ///< [vertices] at the start of the step [m]
    std::vector<Vec3> x_t1;          ///< [vertices] at its end [m]
};

/// Bounding box of a point set.
struct Bounds {
    Vec3 lower = Vec3::Constant(1e300);
    Vec3 upper = Vec3::Constant(-1e300);

    TOILE_HD void extend(const Vec3& point)
    {
        lower = lower.cwiseMin(point);
        upper = upper.cwiseMax(point);
    }
    TOILE_HD bool empty() const { return lower.x() > upper.x(); }
    Vec3 center() const { return 0.5 * (lower + upper); }
    double diagonal() const { return empty() ? 0.0 : (upper - lower).norm(); }
};
Bounds bounds(View<const Vec3> points);

/// Distance [m] from the origin along an axis beyond which coordinates are out of range. Caches and rays are
/// in single precision, which has steps of 8 mm there.
inline constexpr double kFarthest = 1e5;

/// True for coordinates that are finite and at most kFarthest.
inline bool is_in_range(const Vec3& point)
{
    return point.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= kFarthest;
}

/// @throws InvalidInput naming `source` and the first point that is out of range
void require_in_range(View<const Vec3> points, const std::string& source);

/// Throws InvalidInput for a mesh that no solver can use, naming `source` and the first offending element: no
/// triangle, an index out of range, a repeated corner, a position that is not finite, a triangle whose height
/// is below kMinHeightRatio of its longest edge.
void require_usable(const TriangleMesh& mesh, const std::string& source);

/// What require_usable() refuses of a triangle, with a remedy; empty for a good one.
std::string defect_of(const TriangleMesh& mesh, int triangle);

/// Min height of a triangle over its longest edge [-]. Thinner ones count as zero-area: the bending energy
/// squares their rest shape twice, after which it has no direction left in double precision.
inline constexpr double kMinHeightRatio = 1e-6;

/// Area-weighted vertex normals, unit length (zero for an isolated vertex). [vertices]
std::vector<Vec3> vertex_normals(View<const Vec3> positions, View<const Triangle> triangles);

/// Splits every triangle into four at its edge midpoints, `levels` times. Old vertices keep their index.
/// Midpoints of shared edges are shared.
TriangleMesh subdivide(const TriangleMesh& mesh, int levels);

} // namespace toile
