#pragma once

#include "core/mesh/obj.h"
#include "core/mesh/triangle_mesh.h"

namespace toile {

/// Flips faces until neighbours agree: faces that share an edge run along it in opposite directions.
///
/// Each piece (faces joined by edges of two faces) keeps the orientation of the majority of its faces, of the
/// first face in a tie. Texture indices are reversed with their face; vertices and the order of faces stay.
///
/// Edges of three or more faces join nothing. A one-sided piece (a Moebius strip) keeps edges that disagree.
/// build_topology() names and refuses both.
/// @param mesh  every index in range, as read_obj() returns it
/// @return number of flipped faces, 0 for a consistent mesh
int make_windings_agree(ObjMesh& mesh);

/// Turns the triangles of a body so that all closed pieces have their outside outwards. Windings are made to
/// agree as above. A closed piece of negative volume is turned with all closed pieces that it encloses; one
/// that lies in a piece of positive volume is a cavity, and stays.
/// @param mesh  every index in range
/// @return number of turned triangles
int face_outwards(TriangleMesh& mesh);

} // namespace toile
