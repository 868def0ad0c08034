#pragma once

#include <string>
#include <vector>

#include "core/mesh/obj.h"
#include "garment/pattern/mesh/pattern_mesh.h"
#include "garment/pattern/mesh/sewn_mesh.h"
#include "scenes/drape/garment_folds.h"

namespace toile::scenes {

/// A garment in space, with its panels as texture and rest shape.
struct GarmentSurface {
    ObjMesh mesh; ///< texture coordinates are those of the panels [m], and a group names each panel
    /// [triangles] rest shape with the warp upwards, where it isn't the texture: seams are gathered, or
    /// panels have a grain [m]
    std::vector<FlatTriangle> rest;
    std::vector<scene::Fold> folds;

    /// Mesh whose texture coordinates are `rest`, with corners of its own for each triangle.
    ObjMesh rest_mesh() const;
};

/// Panels of a garment as meshes, and the surface that they become when their seams are welded.
struct GarmentMesh {
    garment::PatternMesh panels;
    garment::SewnMesh sewn;
    std::vector<std::string> panel_names; ///< [panels]
    std::vector<FlatTriangle> rest;       ///< [triangles] garment::gathered_rest(); empty: the texture
    GarmentFolds folds;

    /// @param edge   [m] of panels that have no edge length of their own
    /// @param least  [m] of any
    GarmentMesh(const garment::Pattern& pattern, double edge, double least = 0.0);

    /// The welded surface.
    /// @param x  [welded vertices] [m]
    GarmentSurface surface(View<const Vec3> x) const { return surface(sewn, x); }

    /// The garment with only some of its seams welded.
    /// @param partly  the panels with those seams
    /// @param x       [its welded vertices] [m]
    GarmentSurface surface(const garment::SewnMesh& partly, View<const Vec3> x) const;

    /// Welded vertices of the edges that have a label, in ascending order.
    std::vector<int> labelled(const garment::Pattern& pattern, const std::string& label) const;
};

/// Mean of the vertices that are welded into one.
/// @param x  [vertices of the panels] [m]
/// @return [welded vertices] [m]
std::vector<Vec3> weld(const garment::SewnMesh& sewn, View<const Vec3> x);
/// The same position for all of them.
/// @param welded  [welded vertices] [m]
/// @return [vertices of the panels] [m]
std::vector<Vec3> unweld(const garment::SewnMesh& sewn, View<const Vec3> welded);

} // namespace toile::scenes
