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

} // namespace toile::research::accuracy
