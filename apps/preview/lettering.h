#pragma once

#include <string_view>

#include "apps/preview/image.h"

namespace toile::preview {

/// Size of letters in dots: 5 x 7 above the line and 2 below it, with one between them.
inline constexpr int kLetterWidth = 6, kLetterHeight = 9, kBelowLine = 2;

/// Writes a line of text into a picture, dark, with its upper left corner at (x, y); what lies outside of the
/// picture is left out. Letters are small or capital, digits, and " .,-+%/<>()"; others are blank.
/// @param dot  [pixels] of a dot of a letter
void draw_text(Image& image, int x, int y, int dot, std::string_view text);

} // namespace toile::preview
