#include "collision/cloth/device_safe_step.h"

#include "core/backend/cuda/parallel.cuh"

namespace toile {

DeviceSafeStep::DeviceSafeStep(const CudaSpace& space, DeviceNearPairs& near, DeviceExemptPairs& exempt,
                               const LeastGap& gap, int vertex_count)
    : space_(space), near_(near), exempt_(exempt), gap_(gap),
      known_motion_(space, "safe_step/known_motion", vertex_count),
      known_radius_(space, "safe_step/known_radius", vertex_count), pairs_(space, "safe_step/pairs"),
      way_(space, "safe_step/way", vertex_count), marks_(space, "safe_step/marks", vertex_count),
      counts_(space, "safe_step/counts", 2), block_sums_(space, "safe_step/block_sums"),
      read_(space, "safe_step/read", 2)
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

bool DeviceSafeStep::leaves_alone(View<const Vec3> x)
{
    const StageScope stage("collision/safe_step");
    parallel_sum(space_, "collision/device_strays", x.size(), 0,
                 CountStrays{base_, x, known(), way_.view(), marks_.view()}, counts_.view().subview(0, 1),
                 block_sums_);
    count_in_the_way(0);
    const auto [strays, in_the_way] = read_counts();
    if (strays == 0 || in_the_way > 0)
        return in_the_way == 0;

    const StageScope again("collision/look_again");
    parallel_for(space_, "collision/know_strays", x.size(),
                 KnowStrays{marks_.view(), way_.view(), slack_, known()});
    const int before = count_;
    exempt_.append_kept(
        near_.find(base_, {known_motion_.view(), known_radius_.view(), marks_.view()}, gap_.most()), pairs_,
        count_);
    count_in_the_way(before);
    return read_counts().in_the_way == 0;
}

/// Of the pairs from the first on.
void DeviceSafeStep::count_in_the_way(int first)
{
    const View<const NearPair> pairs = pairs_.view().subview(first, count_ - first);
    parallel_sum(space_, "collision/device_in_the_way", pairs.size(), 0,
                 CountInTheWay{pairs, {base_, way_.view(), gap_}}, counts_.view().subview(1, 1), block_sums_);
}

DeviceSafeStep::Counts DeviceSafeStep::read_counts()
{
    counts_.download(read_.view());
    space_.synchronise();
    return {read_[0], read_[1]};
}

} // namespace toile
