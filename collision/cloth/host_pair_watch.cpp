#include "collision/cloth/host_pair_watch.h"

#include <algorithm>
#include <iterator>

#include "core/backend/parallel.h"

namespace toile {

void HostPairWatch::begin(View<const Vec3> base, View<const Vec3> expected, View<const double> slack,
                          View<const NearPair> pairs)
{
    base_ = base;
    slack_ = slack;
    expected_pairs_ = pairs;
    more_pairs_.clear();
    known_radius_.resize(base.size());
    known_motion_.resize(base.size());
    parallel_for(kCpu, "collision/know_expected", base.size(), KnowExpected{base, expected, slack, known()});
}

View<const BlockedPair> HostPairWatch::look_at_all(View<const Vec3> x)
{
    motion_.resize(x.size());
    is_marked_.resize(x.size());
    is_stale_.assign(x.size(), 1);
    const CountStrays strays{base_, x, known(), motion_, is_marked_};
    if (parallel_sum(kCpu, x.size(), 0, strays) > 0) {
        parallel_for(kCpu, "collision/know_strays", x.size(),
                     KnowStrays{is_marked_, motion_, slack_, known()});
        look_around_marked();
    }
    return look_at_pairs();
}

View<const BlockedPair> HostPairWatch::look(View<const ChangedWay> changed)
{
    is_stale_.assign(motion_.size(), 0);
    is_marked_.assign(motion_.size(), 0);
    const KnowChanged know{changed, slack_, known(), motion_, is_stale_, is_marked_};
    if (parallel_sum(kCpu, changed.size(), 0, know) > 0)
        look_around_marked();
    return look_at_pairs();
}

/// Adds the pairs of marked vertices.
void HostPairWatch::look_around_marked()
{
    const StageScope stage("collision/look_again");
    near_.find(base_, {known_motion_, known_radius_, is_marked_}, gap_.most(), found_);
    std::copy_if(found_.begin(), found_.end(), std::back_inserter(more_pairs_),
                 [&](const NearPair& pair) { return !exempt_.is_exempt(pair); });
}

/// Of stale vertices; the others have the shares that they had.
View<const BlockedPair> HostPairWatch::look_at_pairs()
{
    pair_share_.resize(pair_count(), 1.0);
    const PairShare share{base_, motion_, gap_};
    parallel_for(kCpu, "collision/safe_share", pair_count(), [&](int i) {
        const NearPair& pair = this->pair(i);
        if (is_any_marked(pair.vertex, is_stale_))
            pair_share_[i] = share(pair);
    });
    blocked_.clear();
    parallel_append(
        kCpu, "collision/in_the_way", pair_count(),
        [&](int begin, int end, std::vector<BlockedPair>& found) {
            for (int i = begin; i < end; ++i)
                if (pair_share_[i] < 1.0)
                    found.push_back({pair(i), pair_share_[i]});
        },
        blocked_);
    return blocked_;
}

} // namespace toile
