#include "collision/cloth/exempt_pairs.h"

namespace toile {

namespace {

/// Distance at rest, of the least gap [-], below which neighbours are too near to be told apart from folded
/// cloth.
constexpr double kTooNear = 10.0;

} // namespace

ExemptPairs::ExemptPairs(View<const Vec3> rest, View<const double> altitude, double least_gap)
    : rest_(rest.begin(), rest.end()), too_near_(kTooNear * least_gap), crosses_(rest.size(), 0)
{
    for (const double height : altitude)
        is_thin_.push_back(height < too_near_);
}

} // namespace toile
