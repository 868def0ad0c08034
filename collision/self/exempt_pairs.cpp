#include "collision/self/exempt_pairs.h"

namespace toile::collision {

namespace {

/// Distance in the start pose, relative to the minimum gap [-], below which neighbours cannot be
/// distinguished from folded cloth.
constexpr double kTooNear = 10.0;

} // namespace

ExemptPairs::ExemptPairs(View<const Vec3> rest, View<const double> altitude, double min_gap)
    : rest_(rest.begin(), rest.end()), too_near_(kTooNear * min_gap), crosses_(rest.size(), 0)
{
    for (const double height : altitude)
        is_thin_.push_back(height < too_near_);
}

} // namespace toile::collision
