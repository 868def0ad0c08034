#include "collision/cloth/impact_zones.h"

#include <algorithm>
#include <numeric>

namespace toile {

void ImpactZones::reset(View<const Vec3> ways, View<const Hold> hold, double slow)
{
    slow_ = slow;
    ways_ = ways;
    hold_.assign(hold.begin(), hold.end());
    for (const int v : touched_.items()) {
        share_[v] = next_share_[v] = 1.0;
        parent_[v] = next_[v] = v;
    }
    const int known = int(parent_.size());
    if (known != ways.size()) {
        share_.assign(ways.size(), 1.0);
        next_share_ = share_;
        parent_.resize(ways.size());
        std::iota(parent_.begin(), parent_.end(), 0);
        next_ = parent_;
        sum_.resize(ways.size());
        common_.resize(ways.size());
    }
    for (VertexSet* set : {&touched_, &unsettled_, &redirected_, &brought_back_, &renewed_, &changed_})
        set->reset(ways.size());
}

void ImpactZones::touch(int v)
{
    if (touched_.has(v))
        return;
    sum_[v] = {ways_[v], 1.0, hold_[v]};
    common_[v] = common_of(sum_[v]);
    touched_.add(v);
}

void ImpactZones::set_body(int v, const Vec3& way, double weight)
{
    touch(v);
    sum_[v] = {weight * way, weight, Hold::kNone};
    common_[v] = common_of(sum_[v]);
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

void ImpactZones::unite(int a, int b, bool at_once)
{
    shorten_path(a);
    shorten_path(b);
    const auto [root, child] = std::minmax({zone(a), zone(b)});
    if (root == child)
        return;
    touch(root);
    touch(child);
    // A vertex that changes nothing but the mean can wait.
    const bool is_root_alone = next_[root] == root, is_child_alone = next_[child] == child;
    const Hold of_root = sum_[root].hold, of_child = sum_[child].hold;
    const bool can_wait = is_root_alone != is_child_alone && std::max(of_root, of_child) != Hold::kIsHeld &&
                          (is_root_alone ? of_root <= of_child : of_child <= of_root);

    parent_[child] = root;
    std::swap(next_[root], next_[child]);
    add(sum_[root], sum_[child]);
    if (at_once || !can_wait) {
        go_on(root);
        return;
    }
    if (is_root_alone)
        common_[root] = common_[child];
    unsettled_.add(root);
}

void ImpactZones::add(Sum& sum, const Sum& other) const
{
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

ImpactZones::Sum ImpactZones::sum_of(int root) const
{
    return touched_.has(root) ? sum_[root] : Sum{ways_[root], 1.0, hold_[root]};
}

Vec3 ImpactZones::common_of(const Sum& sum) const
{
    const Vec3 common = sum.way / sum.weight;
    return common.norm() < slow_ ? Vec3(Vec3::Zero()) : common;
}

/// Where its sum says.
void ImpactZones::go_on(int root)
{
    common_[root] = common_of(sum_[root]);
    redirected_.add(root);
}

void ImpactZones::bring_back_to(int v, double share)
{
    touch(v);
    next_share_[v] = std::min(next_share_[v], share);
    brought_back_.add(v);
}

bool ImpactZones::settle()
{
    bool any = false;
    for (const int former : unsettled_.items()) {
        const int root = zone(former);
        if (common_[root] == common_of(sum_[root]))
            continue;
        go_on(root);
        any = true;
    }
    unsettled_.clear();
    return any;
}

/// Paths are shortened here, for motion() must not.
View<const int> ImpactZones::close_round()
{
    changed_.clear();
    for (const int v : brought_back_.items()) {
        share_[v] = next_share_[v];
        changed_.add(v);
    }
    renewed_.clear();
    for (const int former : redirected_.items())
        renewed_.add(zone(former));
    for (const int root : renewed_.items()) {
        int v = root;
        do {
            parent_[v] = root;
            changed_.add(v);
            v = next_[v];
        } while (v != root);
    }
    brought_back_.clear();
    redirected_.clear();
    return changed_.items();
}

Vec3 ImpactZones::common(int v) const
{
    const int root = zone(v);
    return touched_.has(root) ? common_[root] : common_of(sum_of(root));
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
