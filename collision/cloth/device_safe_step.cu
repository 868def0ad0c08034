#include "collision/cloth/device_safe_step.h"

#include <algorithm>

#include "core/backend/cuda/parallel.cuh"
#include "core/backend/cuda/roomy.h"

namespace toile {

DeviceSafeStep::DeviceSafeStep(const CudaSpace& space, AsyncNearPairs& near, DeviceExemptPairs& exempt,
                               const LeastGap& gap, int vertex_count)
    : space_(space), near_(near), exempt_(exempt), gap_(gap),
      known_motion_(space, "safe_step/known_motion", vertex_count),
      known_radius_(space, "safe_step/known_radius", vertex_count), pairs_(space, "safe_step/pairs"),
      way_(space, "safe_step/way", vertex_count), is_in_the_way_(space, "safe_step/is_in_the_way"),
      is_stale_(space, "safe_step/is_stale", vertex_count), marks_(space, "safe_step/marks", vertex_count),
      counts_(space, "safe_step/counts", 2), block_sums_(space, "safe_step/block_sums"),
      places_(space, "safe_step/places"), listed_(space, "safe_step/listed", 1),
      scratch_(space, "safe_step/scratch"), changed_(space, "safe_step/changed"),
      host_changed_(space, "safe_step/host_changed"), blocked_(space, "safe_step/blocked"),
      host_blocked_(space, "safe_step/host_blocked")
{
}

void DeviceSafeStep::begin(View<const Vec3> x, View<const Vec3> expected, View<const double> slack,
                           View<const NearPair> found)
{
    base_ = x;
    slack_ = slack;
    parallel_for(space_, "collision/know_expected", x.size(), KnowExpected{x, expected, slack, known()});
    count_ = 0;
    exempt_.append_kept(found, pairs_, count_);
    expected_count_ = count_;
}

View<const BlockedPair> DeviceSafeStep::look_at_all(View<const Vec3> x)
{
    parallel_sum(space_, "collision/device_strays", x.size(), 0,
                 CountStrays{base_, x, known(), way_.view(), marks_.view()}, counts_.view().subview(0, 1),
                 block_sums_);
    is_stale_.fill_zero();
    count_in_the_way(0);
    Counts counts = read_counts();
    if (counts.strays > 0) {
        parallel_for(space_, "collision/know_strays", x.size(),
                     KnowStrays{marks_.view(), way_.view(), slack_, known()});
        const int before = count_;
        look_around_marked(counts.strays);
        count_in_the_way(before);
        counts = read_counts();
    }
    return counts.in_the_way == 0 ? View<const BlockedPair>() : list_in_the_way();
}

View<const BlockedPair> DeviceSafeStep::look(View<const ChangedWay> changed)
{
    const View<ChangedWay> sent = first_items(host_changed_, changed.size());
    std::copy(changed.begin(), changed.end(), sent.begin());
    changed_.upload(sent);
    is_stale_.fill_zero();
    marks_.fill_zero();
    parallel_sum(space_, "collision/device_know_changed", changed.size(), 0,
                 KnowChanged{changed_.view(), slack_, known(), way_.view(), is_stale_.view(), marks_.view()},
                 counts_.view().subview(0, 1), block_sums_);
    const int before = count_;
    if (const int strays = read_counts().strays; strays > 0)
        look_around_marked(strays);
    count_in_the_way(before);
    return list_in_the_way();
}

/// Appends the pairs of marked vertices.
/// @param count  of these
void DeviceSafeStep::look_around_marked(int count)
{
    const StageScope stage("collision/look_again");
    const Ways ways{known_motion_.view(), known_radius_.view(), marks_.view()};
    exempt_.append_kept(near_.find_around(base_, ways, count, gap_.most()), pairs_, count_);
}

/// @param known  pairs before this one are looked at where they have a stale vertex
void DeviceSafeStep::count_in_the_way(int known)
{
    if (is_in_the_way_.size() < count_)
        is_in_the_way_.resize_keeping(pairs_.size());
    parallel_sum(space_, "collision/device_in_the_way", count_, 0,
                 CountInTheWay{pairs_.view().subview(0, count_),
                               {base_, way_.view(), gap_},
                               is_stale_.view(),
                               known,
                               is_in_the_way_.view().subview(0, count_)},
                 counts_.view().subview(1, 1), block_sums_);
}

DeviceSafeStep::Counts DeviceSafeStep::read_counts()
{
    space_.synchronise();
    return {counts_[0], counts_[1]};
}

/// To the host.
View<const BlockedPair> DeviceSafeStep::list_in_the_way()
{
    const int number = list_flagged(space_, "collision/device_list_in_the_way",
                                    is_in_the_way_.view().subview(0, count_), places_, listed_, scratch_);
    const View<BlockedPair> read = first_items(host_blocked_, number);
    parallel_for(space_, "collision/device_report_in_the_way", number,
                 ReportInTheWay{pairs_.view().subview(0, count_),
                                {base_, way_.view(), gap_},
                                places_.view(),
                                first_items(blocked_, number)});
    blocked_.download_first(read);
    space_.synchronise();
    return read;
}

} // namespace toile
