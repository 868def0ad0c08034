#include "collision/cloth/impact_zones.h"

#include <algorithm>

namespace toile {

void ImpactZones::reset(View<const Vec3> ways, View<const unsigned char> held, double slow)
{
    slow_ = slow;
    ways_ = ways;
    held_ = held;
    share_.assign(ways.size(), 1.0);
    next_share_ = share_;
    parent_.resize(ways.size());
    sum_.resize(ways.size());
    for (int v = 0; v < ways.size(); ++v) {
        parent_[v] = v;
        sum_[v] = {ways[v], 1.0, held[v] != 0};
    }
}

/// The vertex that names the zone of v.
int ImpactZones::zone(int v)
{
    while (parent_[v] != v) {
        parent_[v] = parent_[parent_[v]];
        v = parent_[v];
    }
    return v;
}

void ImpactZones::join(int a, int b)
{
    const auto [root, child] = std::minmax({zone(a), zone(b)});
    if (root == child)
        return;
    parent_[child] = root;
    Sum& sum = sum_[root];
    const Sum& other = sum_[child];
    if (sum.is_held && other.is_held) {
        if (other.way.squaredNorm() < sum.way.squaredNorm())
            sum = other;
    } else if (other.is_held) {
        sum = other;
    } else if (!sum.is_held) {
        sum.way += other.way;
        sum.weight += other.weight;
    }
}

Vec3 ImpactZones::common(int v)
{
    const Sum& sum = sum_[zone(v)];
    const Vec3 common = sum.way / sum.weight;
    return common.norm() < slow_ ? Vec3(Vec3::Zero()) : common;
}

Vec3 ImpactZones::motion(int v)
{
    const double share = share_[v];
    if (share == 1.0)
        return ways_[v];
    const Vec3 common = this->common(v);
    return common + share * (ways_[v] - common);
}

} // namespace toile
