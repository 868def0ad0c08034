#pragma once

#include "collision/cloth/near_pairs.h"
#include "collision/surface_edges.h"

namespace toile {

/// Weight of a corner [-] below which the closest point counts as off that corner: one that lies on an edge
/// up to rounding is on it for both triangles, so that one of them speaks for both.
inline constexpr double kOffCorner = 1e-9;

/// Greatest component [-] of the direction between two edges along a face beside one of them: where it is
/// larger the face comes nearer than its edge. Above 0 for edges that stand out on one side only.
inline constexpr double kIntoFace = 0.1;

/// Sine of the slope off an edge up to which the faces beside it are flat [-]: one degree.
inline constexpr double kFlat = 0.0175;

/// NearPair::is_facing of a vertex and triangle t, whose pair is complete but for that.
bool is_facing_triangle(const SurfaceEdges& edges, View<const Triangle> triangles, View<const Vec3> x,
                        const NearPair& pair, int t);

/// NearPair::is_facing of edges e and f, whose pair is complete but for that.
bool is_facing_edges(const SurfaceEdges& edges, View<const Triangle> triangles, View<const Vec3> x,
                     const NearPair& pair, int e, int f);

} // namespace toile
