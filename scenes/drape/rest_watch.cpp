#include "scenes/drape/rest_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::scenes {

namespace {

double max_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double largest = 0.0;
    for (size_t v = 0; v < a.size(); ++v)
        largest = std::max(largest, (a[v] - b[v]).norm());
    return largest;
}

} // namespace

void RestWatch::add(View<const Vec3> x)
{
    samples_.emplace_back(x.begin(), x.end());
    while (samples_.size() > size_t(std::lround(kDuration / frame_)) + 1)
        samples_.pop_front();
    speed_ = motion_ = 0.0;
    for (size_t i = 1; i < samples_.size(); ++i) {
        speed_ = std::max(speed_, max_distance(samples_[i], samples_[i - 1]) / frame_);
        motion_ = std::max(motion_, max_distance(samples_[i], samples_.front()));
    }
}

bool RestWatch::is_at_rest() const
{
    return samples_.size() == size_t(std::lround(kDuration / frame_)) + 1 && speed_ <= kMaxSpeed &&
           motion_ <= kMaxMotion;
}

} // namespace toile::scenes
