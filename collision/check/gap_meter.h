#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/compute/types.h"

namespace toile::collision {

/// Minimum distance between cloth and cloth: of a vertex to a triangle, or of two edges, without a common
/// vertex. Double precision, not exact, and independent of contact detection.
///
/// In a sheet every vertex is near the triangles around it, already at rest. Within one connected piece a
/// pair therefore counts only if it is nearer than half of its rest distance: where cloth folds onto itself.
/// A sharp crease counts too, once its faces close to within about 30 degrees. Pairs of two pieces always
/// count. A pair of one piece that touches at rest never does.
class GapMeter {
public:
    /// Copies the mesh and finds its connected pieces. O(n log n).
    /// @param triangles  [triangles x 3]
    /// @param rest       [vertices x 3] positions at rest [m]; only distances within a connected piece matter
    GapMeter(View<const Triangle> triangles, View<const Vec3> rest);

    struct Gap {
        double distance = 0.0;     ///< [m]
        Vec3 point = Vec3::Zero(); ///< vertex or edge end at the minimum [m]
    };

    /// Minimum distance, or nothing if no pair that counts is nearer than `reach` [m]. Skips primitives with
    /// a corner that is not finite. The same for every number of threads.
    /// @param x  [vertices x 3] [m]
    std::optional<Gap> measure(View<const Vec3> x, double reach) const;

private:
    std::optional<Gap> nearest_triangle(View<const Vec3> x, double reach) const;
    std::optional<Gap> nearest_edges(View<const Vec3> x, double reach) const;

    std::vector<Triangle> triangles_;
    std::vector<std::array<int, 2>> edges_;
    std::vector<Vec3> rest_;
    std::vector<int> piece_of_; ///< [vertices] number of the connected piece
};

} // namespace toile::collision
