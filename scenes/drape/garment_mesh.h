#pragma once

#include <string>
#include <vector>

#include "core/mesh/obj.h"
#include "garment/pattern/mesh/pattern_mesh.h"
#include "garment/pattern/mesh/sewn_mesh.h"

namespace toile::scenes {

/// Panels of a garment as meshes, and the surface that they become when their seams are welded.
struct GarmentMesh {
    garment::PatternMesh panels;
    garment::SewnMesh sewn;
    std::vector<std::string> panel_names; ///< [panels]

    /// @param edge   [m] of panels that have no edge length of their own
    /// @param least  [m] of any
    GarmentMesh(const garment::Pattern& pattern, double edge, double least = 0.0);

    /// Panels side by side with a thread for every pair of stitched vertices; texture coordinates are those
    /// of the panels [m], and a group names each panel.
    /// @param x  [vertices of the panels] [m]
    ObjMesh unsewn(View<const Vec3> x) const;

    /// The welded surface with the same texture coordinates and groups.
    /// @param x  [welded vertices] [m]
    ObjMesh welded(View<const Vec3> x) const;

    /// Mean of the vertices that are welded into one. [welded vertices] [m]
    std::vector<Vec3> weld(View<const Vec3> x) const;
    /// The same position for all of them. [vertices of the panels] [m]
    std::vector<Vec3> unweld(View<const Vec3> welded) const;

    /// Welded vertices of the edges that have a label, in ascending order.
    std::vector<int> labelled(const garment::Pattern& pattern, const std::string& label) const;

    /// Largest distance between the sides of each seam. [seams] [m]
    std::vector<double> seam_gaps(View<const Vec3> x) const;

private:
    void add_groups(ObjMesh& mesh) const;
};

} // namespace toile::scenes
