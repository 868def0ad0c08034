#include "collision/cloth/impact_zones.h"

#include <algorithm>

namespace toile {

void ImpactZones::reset(View<const Vec3> ways, View<const Hold> hold, double slow)
{
    slow_ = slow;
    ways_ = ways;
    share_.assign(ways.size(), 1.0);
    next_share_ = share_;
    parent_.resize(ways.size());
    sum_.resize(ways.size());
    for (int v = 0; v < ways.size(); ++v) {
        parent_[v] = v;
        sum_[v] = {ways[v], 1.0, hold[v]};
    }
}

/// The vertex that names the zone of v.
int ImpactZones::zone(int v) const
{
    while (parent_[v] != v)
        v = parent_[v];
    return v;
}

/// The path from v to the one that names its zone, by half.
void ImpactZones::shorten_path(int v)
{
    while (parent_[v] != v) {
        parent_[v] = parent_[parent_[v]];
        v = parent_[v];
    }
}

void ImpactZones::join(int a, int b)
{
    shorten_path(a);
    shorten_path(b);
    const auto [root, child] = std::minmax({zone(a), zone(b)});
    if (root == child)
        return;
    parent_[child] = root;
    Sum& sum = sum_[root];
    const Sum& other = sum_[child];
    if (other.hold > sum.hold) {
        sum = other;
    } else if (other.hold == sum.hold && sum.hold == Hold::kIsHeld) {
        if (other.way.squaredNorm() < sum.way.squaredNorm())
            sum = other;
    } else if (other.hold == sum.hold) {
        sum.way += other.way;
        sum.weight += other.weight;
    }
}

/// Paths are halved here, for motion() must not.
void ImpactZones::close_round()
{
    share_ = next_share_;
    for (int& parent : parent_)
        parent = parent_[parent];
}

Vec3 ImpactZones::common(int v) const
{
    const Sum& sum = sum_[zone(v)];
    const Vec3 common = sum.way / sum.weight;
    return common.norm() < slow_ ? Vec3(Vec3::Zero()) : common;
}

Vec3 ImpactZones::motion(int v) const
{
    const double share = share_[v];
    if (share == 1.0)
        return ways_[v];
    const Vec3 common = this->common(v);
    return common + share * (ways_[v] - common);
}

} // namespace toile
