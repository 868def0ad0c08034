#pragma once

#include <vector>

#include "scenes/drape/garment_mesh.h"
#include "scenes/format/scene.h"

/// Notions of a pattern, elastics and buttons, on the meshes of its panels.
namespace toile::scenes {

/// Welded vertices along a part of an edge; two at least. It begins and ends at those nearest to its ends.
std::vector<int> path_along(const garment::EdgePart& part, const GarmentMesh& mesh);

/// Elastics of a pattern as paths of welded vertices, one for each edge or part of one. Parts begin and end
/// at the vertices nearest to their ends.
std::vector<scene::Elastic> elastics_of(const garment::Pattern& pattern, const GarmentMesh& mesh);

/// Vertex of the panels' mesh that is nearest to a point of a panel.
int nearest_vertex(const garment::PatternMesh& mesh, const garment::PanelPoint& point);

/// Closures of a pattern as tacks between welded vertices, with the times that the pattern gives. Those whose
/// ends are one vertex are left out.
/// @param partly  the mesh with some or all of its seams welded
std::vector<scene::Tack> tacks_of(const garment::Pattern& pattern, const garment::PatternMesh& mesh,
                                  const garment::SewnMesh& partly);

/// Distance of the ends of each closure of a pattern [m].
/// @param x  [welded vertices] [m]
std::vector<double> closure_gaps(const garment::Pattern& pattern, const GarmentMesh& mesh,
                                 View<const Vec3> x);

} // namespace toile::scenes
