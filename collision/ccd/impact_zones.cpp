#include "collision/ccd/impact_zones.h"

#include <algorithm>
#include <numeric>

namespace toile::collision {

void ImpactZones::reset(View<const Vec3> displacements, View<const Support> support, double slow)
{
    slow_ = slow;
    displacements_ = displacements;
    support_.assign(support.begin(), support.end());
    for (const int v : active_.items()) {
        fraction_[v] = next_fraction_[v] = 1.0;
        parent_[v] = next_[v] = v;
    }
    const int known = int(parent_.size());
    if (known != displacements.size()) {
        fraction_.assign(displacements.size(), 1.0);
        next_fraction_ = fraction_;
        parent_.resize(displacements.size());
        std::iota(parent_.begin(), parent_.end(), 0);
        next_ = parent_;
        sum_.resize(displacements.size());
        common_.resize(displacements.size());
    }
    for (VertexSet* set : {&active_, &redirected_, &limited_, &renewed_, &changed_})
        set->reset(displacements.size());
}

void ImpactZones::activate(int v)
{
    if (active_.has(v))
        return;
    sum_[v] = {displacements_[v], 1.0, support_[v]};
    common_[v] = common_of(sum_[v]);
    active_.add(v);
}

void ImpactZones::set_body(int v, const Vec3& displacement, double weight)
{
    activate(v);
    sum_[v] = {weight * displacement, weight, Support::kNone};
    common_[v] = common_of(sum_[v]);
}

/// Root of the zone of v.
int ImpactZones::zone(int v) const
{
    while (parent_[v] != v)
        v = parent_[v];
    return v;
}

/// Halves the path from v to its root.
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
    activate(root);
    activate(child);
    parent_[child] = root;
    std::swap(next_[root], next_[child]);
    add(sum_[root], sum_[child]);
    common_[root] = common_of(sum_[root]);
    redirected_.add(root);
}

void ImpactZones::add(Sum& sum, const Sum& other) const
{
    if (other.support > sum.support) {
        sum = other;
    } else if (other.support == sum.support && sum.support == Support::kFixed) {
        if (other.displacement.squaredNorm() < sum.displacement.squaredNorm())
            sum = other;
    } else if (other.support == sum.support) {
        sum.displacement += other.displacement;
        sum.weight += other.weight;
    }
}

ImpactZones::Sum ImpactZones::sum_of(int root) const
{
    return active_.has(root) ? sum_[root] : Sum{displacements_[root], 1.0, support_[root]};
}

Vec3 ImpactZones::common_of(const Sum& sum) const
{
    const Vec3 common = sum.displacement / sum.weight;
    return common.norm() < slow_ ? Vec3(Vec3::Zero()) : common;
}

void ImpactZones::limit_by(int v, double factor)
{
    activate(v);
    next_fraction_[v] = std::min(next_fraction_[v], factor * fraction_[v]);
    limited_.add(v);
}

/// Shortens paths here, because motion() must not.
View<const int> ImpactZones::close_pass()
{
    changed_.clear();
    for (const int v : limited_.items()) {
        fraction_[v] = next_fraction_[v];
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
    limited_.clear();
    redirected_.clear();
    return changed_.items();
}

Vec3 ImpactZones::common(int v) const
{
    const int root = zone(v);
    return active_.has(root) ? common_[root] : common_of(sum_of(root));
}

Vec3 ImpactZones::motion(int v) const
{
    const double fraction = fraction_[v];
    if (fraction == 1.0)
        return displacements_[v];
    const Vec3 common = this->common(v);
    return common + fraction * (displacements_[v] - common);
}

} // namespace toile::collision
