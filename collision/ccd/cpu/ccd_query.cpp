#include "collision/ccd/cpu/ccd_query.h"

#include <algorithm>
#include <iterator>

#include "core/compute/parallel.h"

namespace toile::collision {

void CpuCcdQuery::begin(View<const Vec3> base, View<const Vec3> expected, View<const double> slack,
                        View<const NearPair> pairs)
{
    base_ = base;
    slack_ = slack;
    expected_pairs_ = pairs;
    more_pairs_.clear();
    known_radius_.resize(base.size());
    known_motion_.resize(base.size());
    parallel_for(kCpu, "collision/record_expected", base.size(),
                 RecordExpected{base, expected, slack, known()});
}

View<const BlockedPair> CpuCcdQuery::query_all(View<const Vec3> x)
{
    motion_.resize(x.size());
    is_marked_.resize(x.size());
    is_stale_.assign(x.size(), 1);
    const MarkOutOfBounds mark{base_, x, known(), motion_, is_marked_};
    if (parallel_sum(kCpu, x.size(), 0, mark) > 0) {
        parallel_for(kCpu, "collision/widen_known", x.size(),
                     WidenKnown{is_marked_, motion_, slack_, known()});
        find_near_marked();
    }
    return query_pairs();
}

View<const BlockedPair> CpuCcdQuery::update(View<const ChangedTrajectory> changed)
{
    is_stale_.assign(motion_.size(), 0);
    is_marked_.assign(motion_.size(), 0);
    const RecordChanged record{changed, slack_, known(), motion_, is_stale_, is_marked_};
    if (parallel_sum(kCpu, changed.size(), 0, record) > 0)
        find_near_marked();
    return query_pairs();
}

/// Adds the pairs of marked vertices.
void CpuCcdQuery::find_near_marked()
{
    const StageScope stage("collision/search_again");
    near_.find(base_, {known_motion_, known_radius_, is_marked_}, gap_.largest(), found_);
    std::copy_if(found_.begin(), found_.end(), std::back_inserter(more_pairs_),
                 [&](const NearPair& pair) { return !exempt_.is_exempt(pair); });
}

/// Updates the fractions of pairs with stale vertices, and lists all blocked pairs.
View<const BlockedPair> CpuCcdQuery::query_pairs()
{
    pair_fraction_.resize(pair_count(), 1.0);
    const PairSafeFraction fraction{base_, motion_, gap_};
    parallel_for(kCpu, "collision/max_safe_step", pair_count(), [&](int i) {
        const NearPair& pair = this->pair(i);
        if (is_any_marked(pair.vertex, is_stale_))
            pair_fraction_[i] = fraction(pair);
    });
    blocked_.clear();
    parallel_append(
        kCpu, "collision/blocked", pair_count(),
        [&](int begin, int end, std::vector<BlockedPair>& found) {
            for (int i = begin; i < end; ++i)
                if (pair_fraction_[i] < 1.0)
                    found.push_back({pair(i), pair_fraction_[i]});
        },
        blocked_);
    return blocked_;
}

} // namespace toile::collision
