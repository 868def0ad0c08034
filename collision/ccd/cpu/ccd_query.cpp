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
    complete_count_ = pair_count();
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
    if (const int count = parallel_sum(kCpu, x.size(), 0, mark); count > 0) {
        parallel_for(kCpu, "collision/widen_known", x.size(),
                     WidenKnown{is_marked_, motion_, slack_, known()});
        find_near_marked(count);
    }
    return query_pairs();
}

View<const BlockedPair> CpuCcdQuery::update(View<const ChangedTrajectory> changed)
{
    is_stale_.assign(motion_.size(), 0);
    is_marked_.assign(motion_.size(), 0);
    const RecordChanged record{changed, slack_, known(), motion_, is_stale_, is_marked_};
    if (const int count = parallel_sum(kCpu, changed.size(), 0, record); count > 0)
        find_near_marked(count);
    return query_pairs();
}

/// Adds the pairs of marked vertices, or replaces all since begin(): is_search_complete().
/// @param count  of marked vertices
void CpuCcdQuery::find_near_marked(int count)
{
    const StageScope stage("collision/search_again");
    const bool is_complete = is_search_complete(count, base_.size(), pair_count(), complete_count_);
    if (is_complete) {
        more_pairs_.clear();
        pair_fraction_.resize(std::min(int(pair_fraction_.size()), pair_count()));
        is_stale_.assign(base_.size(), 1);
        parallel_for(kCpu, "collision/recentre_known", base_.size(),
                     RecentreKnown{motion_, slack_, known(), is_marked_});
    }
    near_.find(base_, {known_motion_, known_radius_, is_marked_}, gap_.largest(), found_);
    std::copy_if(found_.begin(), found_.end(), std::back_inserter(more_pairs_),
                 [&](const NearPair& pair) { return !exempt_.is_exempt(pair); });
    if (is_complete)
        complete_count_ = pair_count();
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
