#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/toile/pattern/report.h"
#include "garment/pattern/mesh/mesh_quality.h"
#include "garment/pattern/mesh/sewn_mesh.h"

namespace toile::app {

/// What `toile pattern mesh` says about the mesh of a pattern.
struct MeshReport {
    PatternReport pattern;
    garment::PatternMesh mesh;
    std::vector<double> targets; ///< [panels] edge lengths that were asked for [m]
    garment::MeshQuality quality;
    std::vector<garment::MeshQuality> panels; ///< [panels]
    garment::SewnMesh sewn;

    /// Seam to flip if the sewn surface is one-sided: one that is reported as twisted, if any is.
    std::optional<int> one_sided_seam() const;

    /// Class of failure: ok, seams (the surface is one-sided) or meshing (it is not manifold).
    const char* outcome() const;
};

/// @param edge  value of --edge [m]
/// @throws InvalidInput unless it is a length that edges of a mesh may have
void require_edge_option(double edge);

/// Why the pattern can't be sewn, in one line with the remedy; empty if it can.
std::string failure_of(const MeshReport& report);

/// Meshes and measures a pattern. Panels without a target of their own have that of `edge` [m].
/// @throws InvalidInput as garment::mesh_pattern() does
MeshReport mesh_report_on(garment::Pattern pattern, double edge);

/// A line per panel and seam, then the sewn surface.
std::string to_text(const MeshReport& report);

/// The same as JSON.
std::string to_json(const MeshReport& report);

} // namespace toile::app
