#pragma once

#include <optional>
#include <string>
#include <vector>

namespace toile::exports {

/// Bounds of what a file may say.
inline constexpr double kMaxStartFrame = 1e9;
inline constexpr int kMaxSubframes = 1000;

/// Rate and first frame of samples.
struct FrameTimes {
    double fps = 0.0;         ///< [frames/s]
    int subframes = 1;        ///< samples per frame
    double start_frame = 0.0; ///< of the first sample
};

/// What samples at these times are. Rounding in the file is undone: 23.99999 is 24, 29.97003 is 30000/1001,
/// and frame 1000.99999 is 1001.
/// @param times     [s] two or more
/// @param rounding  [s] largest error of a time
/// @param fps       [frames/s] that the file names; empty: a sample is a frame
/// @return none for samples that are not at regular times
std::optional<FrameTimes> frame_times(const std::vector<double>& times, double rounding,
                                      std::optional<double> fps);

/// What is wrong with times of samples [s], which must increase and be within 1e9 s of zero: "sample 3 is at
/// 0.5 s ..."; empty for good ones.
std::string fault_of_times(const std::vector<double>& times);

} // namespace toile::exports
