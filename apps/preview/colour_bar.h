#pragma once

#include <span>
#include <string>

#include "apps/preview/colour_map.h"
#include "apps/preview/image.h"

namespace toile::preview {

/// Legend of a map.
struct Legend {
    std::string title; ///< what is shown, with its unit
    ColourScale scale;
    double shown_per_value =
        1.0; ///< of the numbers beside the bar: 100 for values that are shown in per cent
};

/// Pictures of equal size side by side, with captions below, and the colour bar with numbers at their right.
/// @param captions  one for each picture
/// @throws InvalidInput as contact_sheet()
Image with_colour_bar(std::span<const Image> pictures, std::span<const std::string> captions,
                      const Legend& legend);

} // namespace toile::preview
