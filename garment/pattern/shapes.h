#pragma once

#include "core/mesh/triangle_mesh.h"

namespace toile::garment {

/// Generated cloth: flat sheets and a simple skirt, as triangle surfaces in space (Y up, normals up or
/// outwards). Their initial shape is their rest shape.

/// A rectangle in the plane y = 0, centred, `size` [m] along x and z, edges of about `resolution` [m].
/// Diagonals alternate, so that neither is preferred.
TriangleMesh cut_rectangle(const Vec2& size, double resolution);

/// A disc in the plane y = 0, centred: concentric rings of near-equilateral triangles.
TriangleMesh cut_disc(double radius, double resolution);

struct SkirtCut {
    double waist_radius = 0.12; ///< [m] circumference / 2 pi
    double hem_radius = 0.25;   ///< [m] at least the waist's
    double length = 0.5;        ///< [m] along the cloth, from waist to hem
    double resolution = 0.015;  ///< [m]
};

/// A skirt as a truncated cone around the Y axis: waist at y = 0, hem below. Towards the hem its
/// radius deviates by up to 0.2 %, as that of cloth does: a perfect cone hangs like a lampshade. A quarter,
/// half or full circle skirt is the cone whose length equals (hem_radius - waist_radius) / sin(opening).
/// @throws InvalidInput if the hem lies further out than the length reaches.
TriangleMesh cut_skirt(const SkirtCut& cut);

} // namespace toile::garment
