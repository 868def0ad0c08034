#pragma once

#include <vector>

#include "avatars/model/clip.h"

namespace toile::avatars {

/// Longest time between two keys of a clip that is sampled anew [s]. Shorter steps change no pose visibly.
inline constexpr double kMaxGap = 1.0 / 60.0;

/// Times of all keys of a clip, ascending, each once. Never empty.
std::vector<double> key_times(const Clip& clip);

/// Ascending times, with as many between them that no gap is longer than kMaxGap.
std::vector<double> refined(const std::vector<double>& times);

} // namespace toile::avatars
