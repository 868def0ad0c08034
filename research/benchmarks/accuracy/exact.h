#pragma once

namespace toile::research::accuracy {

/// Drop of the tip over its horizontal reach [-] of a strip clamped horizontally at one end that bends under
/// its own weight, the heavy elastica: theta'' = -G (1 - s) cos(theta), theta(0) = 0, theta'(1) = 0.
/// @param load  [-] G = areal density x gravity x length^3 / rigidity
double heavy_elastica(double load);

/// Sag over the length [-] of an inextensible sheet without rigidity that hangs between two bars, the
/// catenary.
/// @param span  [-] distance of the bars over the length of the sheet, below 1
double catenary_sag(double span);

/// Twist of the tip [-] over a small tilt of gravity out of the plane of a strip that is clamped edge-on,
/// bends sideways and twists under its own weight: phi'' = -g^2/4 (1 - s)^4 (phi - 1), phi'(1) = 0, linear in
/// the tilt. The clamp keeps a strip without Poisson's effect from warping over lambda = width / sqrt(24):
/// phi(0) = -lambda phi'(0) outside of that layer. A narrow strip buckles sideways at g = 12.85, where the
/// twist is unbounded.
/// @param load   [-] g = weight per length x length^3 / sqrt(lateral stiffness x torsional stiffness)
/// @param width  [-] over the length
double lateral_twist(double load, double width);

} // namespace toile::research::accuracy
