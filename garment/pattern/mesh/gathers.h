#pragma once

#include <vector>

#include "core/mesh/obj.h"
#include "garment/pattern/mesh/pattern_mesh.h"

namespace toile::garment {

/// Sides of a seam whose lengths differ by less than this fraction are sewn as they are: seams of a drawing
/// differ by its digits.
inline constexpr double kEvenSides = 1e-3;

/// Rest shape of the triangles of a pattern in the axes of its weave (material_coordinates()), in which
/// longer sides of seams are gathered to the shorter ones, or the shorter stretched (Seam::gather).
///
/// The squared rest length of an edge between vertices a and b is
///
///   l^2 = e^T (C_a + C_b) / 2 e,   C = exp(2 w H)                      [-]
///
/// H [-] is the least strain with d^T H d = log(target length / own length) along the sewn edges d at the
/// vertex; w is 1 on the seam, 1/2 one vertex from it, 0 beyond. Sewn edges have exactly their target length,
/// the same on both sides. Sides of panels that shrink are compared as they are then; they
/// meet where they were sewn before. Triangles that share an edge agree about its length, so that cloth can
/// buckle into the shape without strain. A triangle that these lengths would collapse is deformed by the mean
/// of its H. The warp of a triangle keeps its direction. Without gathers the result is
/// material_coordinates(), bit for bit.
///
/// @return [triangles] corners in the order of mesh.triangles, warp upwards, about the centroid that they
/// have
///         in material_coordinates() [m]; areas have the sign that they have there
std::vector<FlatTriangle> gathered_rest(const Pattern& pattern, const PatternMesh& mesh);

} // namespace toile::garment
