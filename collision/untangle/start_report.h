#pragma once

#include <array>
#include <vector>

#include "core/backend/types.h"

namespace toile {

/// A place where a start pose is wrong: cloth inside a body, or two triangles of cloth through each other.
struct StartPlace {
    enum class Kind { InsideBody, Crossing };

    Kind kind = Kind::InsideBody;
    Vec3 position = Vec3::Zero(); ///< [m] before the repair, or after it where it arose there
    double depth = 0.0;           ///< [m] to the body's surface, or that one triangle has to move
    int cloth = 0;                ///< number of the cloth
    int other = 0;                ///< number of the body, or of the other cloth (may be the same)
    /// Vertices of the cloth that lies inside (one: a vertex; two: the midpoint of an edge; three: the
    /// centroid of a triangle), or of its triangle that crosses.
    std::array<int, 3> vertex{-1, -1, -1};
    bool is_held = false;     ///< every vertex of the place is held: it stays by the user's will
    bool is_repaired = false; ///< gone after the repair
};

/// What a start pose had in it, and what a repair left.
struct StartReport {
    std::vector<StartPlace> places; ///< inside bodies by cloth, then crossings; then what arose and remains
    bool was_repaired = false;      ///< a repair ran; otherwise nothing below is set
    int rounds = 0;                 ///< times that the bodies grew and the cloth was untangled
    double max_strain = 0.0;        ///< [-] largest |length / start length - 1| of an edge after it
    double rms_strain = 0.0;        ///< [-] of all edges
    double max_move = 0.0;          ///< [m] of a vertex

    /// Places of a kind: all of them, or those that remain. A pose that was not repaired keeps all.
    int count(StartPlace::Kind kind) const;
    int remaining(StartPlace::Kind kind) const;

    /// Vertices that began inside a body; places count edges and triangles too.
    int vertices_inside() const;
    double deepest(StartPlace::Kind kind) const; ///< [m] over all places of a kind; 0 when none

    /// True when nothing is wrong that a repair could move.
    bool is_clean() const;
};

} // namespace toile
