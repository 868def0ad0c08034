#pragma once

#include "core/mesh/obj.h"

namespace toile {

/// Turns faces around until neighbours agree: faces that share an edge run through it in opposite directions.
///
/// Each piece (faces joined by edges of two faces) keeps the side that most of its faces have, the first
/// face's when it is a tie. Texture indices turn with their face; vertices and the order of faces stay.
/// Edges of three or more faces join nothing. A piece with one side only (a Moebius strip) keeps edges that
/// disagree; both are left to build_topology, which names and refuses them.
/// @param mesh  every index in range, as read_obj() returns it
/// @return faces that were turned, 0 for a consistent mesh
int make_windings_agree(ObjMesh& mesh);

} // namespace toile
