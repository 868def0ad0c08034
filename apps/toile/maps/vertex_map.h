#pragma once

#include <string>
#include <vector>

#include "apps/preview/colour_map.h"
#include "apps/toile/maps/fitted_garment.h"

namespace toile::app {

/// A quantity at every vertex of a garment, and how it is drawn.
struct VertexMap {
    std::string name;           ///< in names of files: tension, strain, gap, pressure
    std::string unit;           ///< of the values: N/m, m, Pa; empty: none
    std::vector<double> values; ///< [vertices]
    preview::ColourScale scale; ///< range of the colours
    std::string shown_unit;     ///< of the numbers in pictures
    double shown_per_value = 1.0;
};

/// Tension of the fabric: the larger principal force per width at rest [N/m], not negative.
///
/// It is the larger eigenvalue of the Biot stress sym(R^T P) [Ogden 1984, 3.5], where P = dW/dF per area at
/// rest of the membrane and the elastic strain limit (Membrane, StretchTension), and R the isometry closest
/// to the deformation gradient F. Cloth that is pulled by a strain e along its warp has stretch_warp * e.
/// At a vertex it is the mean of the triangles around, weighted by their areas at rest.
VertexMap tension_map(const FittedGarment& garment);

/// Larger principal strain [-], averaged as the tension.
VertexMap strain_map(const FittedGarment& garment);

/// Distance from the skin to the middle of the cloth [m], negative inside. Its colours end at kWidestGap.
VertexMap gap_map(const FittedGarment& garment, const TriangleMesh& body);

/// Pressure of the cloth's tension on the skin [Pa], not negative; 0 farther than kTouching from it.
///
/// At a vertex it is the component along the skin's normal of the force of the membrane and the strain limit,
/// over a third of the triangles around: T / R for a tension T around a cylinder of radius R [Laplace].
/// Weight, bending and inertia are left out. A vertex has the mean of the triangles around, weighted by areas
/// at rest.
VertexMap pressure_map(const FittedGarment& garment, const TriangleMesh& body);

enum class MapKind { Strain, Tension, Gap, Pressure };

/// @param body  needed if needs_body(kind)
VertexMap map_of(MapKind kind, const FittedGarment& garment, const TriangleMesh& body);
inline bool needs_body(MapKind kind) { return kind == MapKind::Gap || kind == MapKind::Pressure; }

/// Gap [m] up to which cloth touches the skin: more than contact leaves between them.
inline constexpr double kTouching = 0.005;

/// Gap [m] from which on all have the same colour, so that pictures of two garments compare.
inline constexpr double kWidestGap = 0.05;

/// Value that a fraction of the values does not exceed.
double quantile(std::vector<double> values, double fraction);

} // namespace toile::app
