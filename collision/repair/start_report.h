#pragma once

#include <array>
#include <vector>

#include "core/compute/types.h"

namespace toile::collision {

/// Defect of a start pose.
struct StartDefect {
    enum class Kind {
        InsideBody,  ///< a point of cloth
        CrossesBody, ///< a triangle of cloth and the surface of a body
        Crossing,    ///< two triangles of cloth
        UnderLayer   ///< cloth of a higher layer under cloth of a lower one; one place stands for all
    };

    Kind kind = Kind::InsideBody;
    Vec3 position = Vec3::Zero(); ///< [m] before the repair, or after it if it arose there
    double depth = 0.0;           ///< [m] to the surface, or the distance that one triangle has to move
    int cloth = 0;                ///< number of the cloth
    int other = 0;                ///< number of the body, or of the other cloth (may be the same)
    /// Vertices of the cloth point that lies inside or under (one: a vertex; two: the midpoint of an edge;
    /// three: the centroid of a triangle), or of the crossing triangle.
    std::array<int, 3> vertex{-1, -1, -1};
    bool is_fixed = false;    ///< every vertex of the defect is fixed by the user, so it stays
    bool is_repaired = false; ///< gone after the repair

    bool is_with_body() const { return kind == Kind::InsideBody || kind == Kind::CrossesBody; }
};

/// Defects of a start pose before and after a repair.
struct StartReport {
    std::vector<StartDefect> defects; ///< by kind and cloth; then new ones that remain
    bool was_repaired = false;        ///< a repair ran; otherwise nothing has moved
    int passes = 0;                   ///< passes of growing bodies and untangling
    double max_strain = 0.0;          ///< [-] largest |length / start length - 1| of an edge after it
    double rms_strain = 0.0;          ///< [-] of all edges
    int edge_count = 0;               ///< number of edges
    double max_move = 0.0;            ///< [m] of a vertex

    /// What the repair did to one cloth.
    struct Change {
        double max_move = 0.0;   ///< [m]
        int vertex = 0;          ///< moved by it
        double strain_p99 = 0.0; ///< [-] not exceeded by 99 % of its edges
    };
    std::vector<Change> changes; ///< [cloths]

    /// [cloths] See find_too_near(); after the repair, if there was one. Of a World solids follow.
    std::vector<std::vector<int>> too_near;

    /// Adds the report of other cloths of the pose.
    void append(const StartReport& other);

    /// Number of defects of a kind: all, or those that remain. A pose that was not repaired keeps all.
    int count(StartDefect::Kind kind) const;
    int remaining(StartDefect::Kind kind) const;

    /// Number of vertices that began inside a body; defects count edges and triangles too.
    int vertices_inside() const;
    int vertices_too_near() const;
    double deepest(StartDefect::Kind kind) const; ///< [m] maximum over all defects of a kind; 0 if none

    /// True if no defect could be repaired by moving cloth: all are fixed.
    bool is_clean() const;
};

} // namespace toile::collision
