#pragma once

#include <string>
#include <vector>

namespace toile {

/// Frames chosen by "first:last:step" out of `frame_count`: last included, any part may be left out, negative
/// numbers count from the end (-1 is the last frame); a single number chooses one frame; empty text all.
/// @throws InvalidInput naming the text for what is no such range or leaves the frames there are.
std::vector<int> parse_frame_range(const std::string& text, int frame_count);

} // namespace toile
