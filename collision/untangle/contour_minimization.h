#pragma once

#include <vector>

#include "collision/untangle/piercings.h"

namespace toile {

/// One step of intersection contour minimisation: wherever an edge goes through a triangle, both move apart
/// in the direction that shortens the curve along which the surfaces cross, edge and triangle by shares.
///
///   G = sum_i ( R_i - 2 (E . R_i) / (E . N) N )                    [Volino and Magnenat-Thalmann 2006]
///
/// E: unit along the edge; N: unit normal of the triangle; R_i: unit along the curve, from the edge into its
/// i-th face. With 1 in place of 2, the change of the curve's end at this edge alone, a modelled suit ended
/// with edges strained by 62 instead of 17 %. Deviation: where a face of the edge and the triangle share a
/// corner the curve ends in it and no shortening takes them apart; there the shorter part of the edge is
/// moved through the triangle.
/// @param x     [vertices] moved [m]
/// @param step  largest displacement of an edge relative to a triangle [m]
void shorten_contours(const JoinedCloths& cloths, const std::vector<Piercing>& piercings, double step,
                      View<Vec3> x);

} // namespace toile
