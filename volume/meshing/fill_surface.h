#pragma once

#include <string>

#include "core/mesh/triangle_mesh.h"
#include "volume/mesh/tet_mesh.h"

namespace toile::volume {

/// Largest number of tetrahedra that a surface is filled with.
inline constexpr double kMaxTets = 5e6;

/// Fills a closed surface with tetrahedra by Delaunay refinement [Jamin et al. 2015, CGALmesh] and smoothing
/// towards an optimal Delaunay triangulation [Alliez et al. 2005], except where that loses volume, as in
/// plates. Edges at which the surface bends by more than 60 degrees are kept; short edges are collapsed, and
/// slivers opened. The same bytes for the same input.
/// @param surface  [m]
/// @param cell     length of edges [m]
/// @throws InvalidInput naming `source` for a surface that is not closed, inside out or crosses itself, and
///         for a cell that would need more than kMaxTets, is longer than the surface or leaves more than a
///         third of it out
TetMesh fill_surface(const TriangleMesh& surface, double cell, const std::string& source);

} // namespace toile::volume
