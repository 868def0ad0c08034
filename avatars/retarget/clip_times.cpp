#include "avatars/retarget/clip_times.h"

#include <algorithm>
#include <cmath>

namespace toile::avatars {

namespace {

template <typename Value>
void append_times(const Track<Value>& track, std::vector<double>& times)
{
    for (const Key<Value>& key : track.keys)
        times.push_back(key.time);
}

} // namespace

std::vector<double> key_times(const Clip& clip)
{
    std::vector<double> times;
    for (const JointTrack& track : clip.tracks) {
        append_times(track.translation, times);
        append_times(track.rotation, times);
        append_times(track.scale, times);
    }
    if (times.empty())
        return {0.0};
    std::sort(times.begin(), times.end());
    constexpr double kSameTime = 1e-4; // [s] within which files write one frame
    times.erase(std::unique(times.begin(), times.end(), [](double a, double b) { return b - a < kSameTime; }),
                times.end());
    return times;
}

std::vector<double> refined(const std::vector<double>& times)
{
    std::vector<double> result{times.front()};
    for (size_t k = 1; k < times.size(); ++k) {
        const double gap = times[k] - times[k - 1];
        const int parts = std::max(1, int(std::ceil(gap / kMaxGap - 1e-6)));
        for (int p = 1; p <= parts; ++p)
            result.push_back(times[k - 1] + gap * p / parts);
    }
    return result;
}

} // namespace toile::avatars
