#include "export/times/frame_times.h"

#include <algorithm>
#include <cmath>

#include "core/base/number.h"
#include "core/time/sample_times.h"

namespace toile::exports {

namespace {

/// Relative error of rates and steps that is rounding in any case.
constexpr double kRounding = 1e-6;

/// Times beyond which none is meant [s]: Alembic's library fills up with larger ones.
constexpr double kMaxTime = 1e9;

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

std::string fault_of_times(const std::vector<double>& times)
{
    for (size_t k = 0; k < times.size(); ++k)
        if (!(std::fabs(times[k]) <= kMaxTime))
            return "sample " + std::to_string(k) + " is at " + short_text(times[k]) + " s";
    const std::optional<int> wrong = first_not_increasing(times);
    if (!wrong)
        return "";
    const size_t k = size_t(*wrong);
    return "sample " + std::to_string(k) + " is at " + shortest_text(times[k]) + " s and the one before at " +
           shortest_text(times[k - 1]) + " s; times must increase";
}

} // namespace toile::exports
