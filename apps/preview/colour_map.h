#pragma once

#include "core/compute/types.h"

namespace toile::preview {

/// Colours of a range of values, dark to light or cold to hot.
enum class ColourMap {
    Viridis, ///< perceptually uniform, also in grey and for colour-blind eyes [Nunez, Anderton, Renslow 2018]
    Turbo,   ///< blue over green to red, as maps of strain have it, without false edges [Mikhailov 2019]
};

/// Colours of the values from `low` to `high`; values outside have those of the ends.
struct ColourScale {
    ColourMap map = ColourMap::Viridis;
    double low = 0.0, high = 1.0; ///< low < high

    Vec3 colour(double value) const; ///< sRGB in [0, 1]
};

} // namespace toile::preview
