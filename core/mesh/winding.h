#pragma once

#include <array>
#include <optional>

#include "core/mesh/obj.h"
#include "core/mesh/triangle_mesh.h"

namespace toile {

/// Flips faces until neighbours agree: faces that share an edge run along it in opposite directions.
///
/// Each piece (faces joined by edges) keeps the orientation of the majority of its faces, of the
/// first face in a tie. Texture indices are reversed with their face; vertices and the order of faces stay.
///
/// Edges of three or more faces join the two that continue each other most straightly. A one-sided piece (a
/// Moebius strip) keeps edges that disagree: one_sided_polygons() names two.
/// @param mesh  every index in range, as read_obj() returns it
/// @return number of flipped faces, 0 for a consistent mesh
int make_windings_agree(ObjMesh& mesh);

/// Number of edges that three or more polygons share.
int branching_edges(const ObjMesh& mesh);

/// Two polygons that run along their common edge in the same direction, if there are any.
std::optional<std::array<int, 2>> one_sided_polygons(const ObjMesh& mesh);

/// Turns the triangles of a body so that all closed pieces have their outside outwards. Windings are made to
/// agree as above. A closed piece of negative volume is turned with all closed pieces that it encloses; one
/// that lies in a piece of positive volume is a cavity, and stays.
/// @param mesh  every index in range
/// @return number of turned triangles
int face_outwards(TriangleMesh& mesh);

} // namespace toile
