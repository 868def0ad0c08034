#pragma once

#include <string>
#include <vector>

namespace toile::app {

/// Frames selected by "first:last:step" out of `frame_count`. The last one is included, parts are optional,
/// and negative numbers count from the end (-1 is the last frame). A single number selects one frame, empty
/// text all.
/// @throws InvalidInput naming the text if it is no range or exceeds the existing frames.
std::vector<int> parse_frame_range(const std::string& text, int frame_count);

} // namespace toile::app
