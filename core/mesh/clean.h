#pragma once

#include <vector>

#include "core/mesh/obj.h"

namespace toile {

/// Drops polygons that have the corners of an earlier one, in any order: duplicates, and the backs of
/// two-sided faces. Groups keep their other polygons.
/// @return number of dropped polygons
int drop_repeated_polygons(ObjMesh& mesh);

/// Removes corners that repeat the one before, and polygons that keep fewer than three: triangles that were
/// stored as quadrilaterals.
/// @return number of changed polygons
int drop_repeated_corners(ObjMesh& mesh);

/// Joins border edges that lie on each other, as along texture seams and between the faces of flat-shaded
/// meshes: the polygons there get the lower of each two vertices. Edges stay apart where three or more meet,
/// and between polygons that lie on each other with all corners: those are layers. Lines follow.
/// @param distance  [m] at which two points are one
/// @return [vertices] vertex that stands for each: itself, or a lower one
std::vector<int> stitch(ObjMesh& mesh, double distance);

/// Distance [m] at which two vertices of a file are one: 1e-6 of the diagonal of the box around all polygons.
double seam_distance(const ObjMesh& mesh);

/// Triangles of a surface that is closed once its seams are stitched; without the vertices that this frees.
TriangleMesh stitched_surface(ObjMesh mesh);

/// Drops lines between the ends of an earlier one, in any direction.
void drop_repeated_lines(ObjMesh& mesh);

/// Drops vertices without a polygon, and lines to them; the others keep their order.
/// @return [vertices before] new number; for a dropped one -1
std::vector<int> drop_loose_vertices(ObjMesh& mesh);

} // namespace toile
