#pragma once

#include <limits>
#include <string>
#include <vector>

#include "garment/pattern/pattern.h"
#include "scenes/drape/garment_mesh.h"

namespace toile::app {

/// Name of the panel (group) of a triangle of a mesh of triangles; empty: it has no groups there.
std::string panel_of_triangle(const ObjMesh& mesh, int triangle);

struct NearPanel {
    std::string name;                                          ///< empty for a mesh without triangles
    double distance = std::numeric_limits<double>::infinity(); ///< [m]
};

/// Panel of the triangle whose centroid is nearest to a point.
/// @param point  [m]
NearPanel panel_near(const ObjMesh& mesh, const Vec3& point);

/// Largest principal strains [-] of all triangles in one fabric.
struct FabricStrain {
    std::string fabric;
    double max = 0.0;
    std::string max_panel;         ///< where it is
    Vec3 max_point = Vec3::Zero(); ///< [m] middle of that triangle
    double p99 = 0.0;              ///< triangles of 99 % of the area at rest are below
    double mean = 0.0;             ///< weighted by the area at rest
};

/// How far a surface is from its texture [Sander, Snyder, Gortler, Hoppe 2001, section 3].
///
/// With the singular values G >= g of the map from texture to surface, triangle by triangle, and areas A of
/// the texture and A' of the surface:
///   L2   = sqrt(sum (G^2 + g^2)/2 A' / sum A' * sum A / sum A'),
///   Linf = max G * sqrt(sum A / sum A')
/// Both are 1 for a surface that lies in its texture without distortion, L2 never less.
struct UvStretch {
    double l2 = 1.0, linf = 1.0; ///< [-]
    double area_ratio = 1.0;     ///< [-] surface over texture
};

struct GarmentMeasures {
    std::vector<FabricStrain> strains; ///< by name of the fabric
    UvStretch uv;
};

/// Measures a garment: its strain against its rest shape, its texture against the flat panels.
/// @param surface  of triangles
/// @param fabric   of panels without one
GarmentMeasures measure_garment(const scenes::GarmentSurface& surface, const garment::Pattern& pattern,
                                const std::string& fabric);

} // namespace toile::app
