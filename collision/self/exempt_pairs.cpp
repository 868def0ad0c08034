#include "collision/self/exempt_pairs.h"

#include <algorithm>

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

void ExemptPairs::set_crossing(View<const unsigned char> crosses)
{
    crosses_.assign(crosses.begin(), crosses.end());
    ++revision_;
}

void ExemptPairs::set_body_crossings(std::vector<BodyCrossing> crossings)
{
    std::sort(crossings.begin(), crossings.end());
    crossings.erase(std::unique(crossings.begin(), crossings.end()), crossings.end());
    body_crossings_ = std::move(crossings);
    ++revision_;
}

void ExemptPairs::set_inside(View<const unsigned char> inside)
{
    inside_.assign(inside.begin(), inside.end());
    ++revision_;
}

void ExemptPairs::add_body_crossings(View<const BodyCrossing> more)
{
    std::vector<BodyCrossing> all = body_crossings_;
    all.insert(all.end(), more.begin(), more.end());
    set_body_crossings(std::move(all));
}

void ExemptPairs::set_let_through(View<const unsigned char> lets_through, View<const Vec3> owner_normal,
                                  View<const Vec3> body_normal)
{
    if (lets_through.empty() && lets_through_.empty())
        return;
    lets_through_ = lets_through;
    owner_normal_ = owner_normal;
    body_normal_ = body_normal;
    ++revision_;
}

} // namespace toile::collision
