#include "export/frame_times.h"

#include <algorithm>
#include <cmath>

namespace toile::exports {

namespace {

/// Relative error of rates and steps that is rounding in any case.
constexpr double kRounding = 1e-6;

/// Frames between a first sample and the frame that it means, in any case.
constexpr double kStartRounding = 1e-4;

/// The whole rate, or the one of video (24000/1001, 30000/1001), that is near; else the rate itself.
double usual_rate(double rate, double tolerance)
{
    constexpr double kVideo = 1000.0 / 1001.0;
    const double whole = std::round(rate), video = std::round(rate / kVideo) * kVideo;
    const double near = std::fabs(whole - rate) <= std::fabs(video - rate) ? whole : video;
    return near > 0.0 && std::fabs(near - rate) <= tolerance * rate ? near : rate;
}

} // namespace

std::optional<FrameTimes> frame_times(const std::vector<double>& times, double rounding,
                                      std::optional<double> fps)
{
    const double first = times.front(), step = (times.back() - first) / double(times.size() - 1);
    if (!(step > 0.0) || !std::isfinite(1.0 / step) || !(std::fabs(first / step) < kMaxStartFrame))
        return std::nullopt;
    for (size_t k = 0; k < times.size(); ++k)
        if (!(std::fabs(times[k] - first - double(k) * step) <= kRounding * step + 2.0 * rounding))
            return std::nullopt;

    FrameTimes found;
    const double tolerance = std::max(kRounding, 2.0 * rounding / (times.back() - first));
    found.fps = usual_rate(1.0 / step, tolerance);
    if (fps) {
        const double per_frame = std::round(1.0 / step / *fps);
        if (per_frame >= 1.0 && per_frame <= kMaxSubframes &&
            std::fabs(1.0 / step / *fps - per_frame) <= tolerance * per_frame) {
            found.fps = usual_rate(*fps, kRounding);
            found.subframes = int(per_frame);
        }
    }
    const double start = first * found.fps * found.subframes, whole = std::round(start); // [samples]
    const bool is_whole =
        std::fabs(start - whole) <= kStartRounding + rounding / step + tolerance * std::fabs(start);
    found.start_frame = (is_whole ? whole : start) / found.subframes;
    return found;
}

} // namespace toile::exports
