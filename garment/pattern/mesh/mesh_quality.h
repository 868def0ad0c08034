#pragma once

#include "garment/pattern/mesh/pattern_mesh.h"

namespace toile::garment {

/// Shape of the triangles of a pattern mesh.
struct MeshQuality {
    int vertices = 0;
    int triangles = 0;
    double mean_edge = 0.0;     ///< [-] length over the panel's target, mean over edges
    double shortest_edge = 0.0; ///< [-] length over the panel's target
    double longest_edge = 0.0;  ///< [-]
    double in_range = 0.0;      ///< [-] fraction of edges between 0.6 and 1.6 of the panel's target

    double smallest_angle = 0.0; ///< [rad]
    int smallest_angle_triangle = 0;

    /// [rad] the same without triangles at forced places: those with a corner in which the outline is sharper
    /// than 60 degrees or beside which it has a side below 0.6 of the target, as a seam may force, and those
    /// from outline to outline, where the panel is too narrow for a vertex inside
    double smallest_free_angle = 0.0;
    int forced_triangles = 0; ///< triangles left out of it
};

MeshQuality quality_of(const PatternMesh& mesh);

/// The same of one panel. `smallest_angle_triangle` counts in the whole mesh.
MeshQuality quality_of_panel(const PatternMesh& mesh, int panel);

} // namespace toile::garment
