#include "collision/ccd/cuda/collision_free_step.h"

#include <algorithm>

#include "core/compute/cuda/grown_array.h"
#include "core/compute/cuda/parallel.cuh"

namespace toile::collision {

DeviceCollisionFreeStep::DeviceCollisionFreeStep(const CudaSpace& space, AsyncNearPairs& near,
                                                 DeviceExemptPairs& exempt, const MinGap& gap,
                                                 int vertex_count)
    : space_(space), near_(near), exempt_(exempt), gap_(gap),
      known_motion_(space, "collision_free_step/known_motion", vertex_count),
      known_radius_(space, "collision_free_step/known_radius", vertex_count),
      pairs_(space, "collision_free_step/pairs"),
      displacement_(space, "collision_free_step/displacement", vertex_count),
      is_blocked_(space, "collision_free_step/is_blocked"),
      is_stale_(space, "collision_free_step/is_stale", vertex_count),
      marks_(space, "collision_free_step/marks", vertex_count),
      counts_(space, "collision_free_step/counts", 2), block_sums_(space, "collision_free_step/block_sums"),
      indices_(space, "collision_free_step/indices"), listed_(space, "collision_free_step/listed", 1),
      scratch_(space, "collision_free_step/scratch"), changed_(space, "collision_free_step/changed"),
      host_changed_(space, "collision_free_step/host_changed"),
      blocked_(space, "collision_free_step/blocked"), host_blocked_(space, "collision_free_step/host_blocked")
{
}

void DeviceCollisionFreeStep::begin(View<const Vec3> x, View<const Vec3> expected, View<const double> slack,
                                    View<const NearPair> found)
{
    base_ = x;
    slack_ = slack;
    parallel_for(space_, "collision/record_expected", x.size(), RecordExpected{x, expected, slack, known()});
    count_ = 0;
    exempt_.append_kept(found, pairs_, count_);
    expected_count_ = complete_count_ = count_;
}

void DeviceCollisionFreeStep::forget_known()
{
    parallel_for(space_, "collision/forget_known", known_motion_.size(), ForgetKnown{known()});
}

View<const BlockedPair> DeviceCollisionFreeStep::query_all(View<const Vec3> x)
{
    parallel_sum(space_, "collision/device_out_of_bounds", x.size(), 0,
                 MarkOutOfBounds{base_, x, known(), displacement_.view(), marks_.view()},
                 counts_.view().subview(0, 1), block_sums_);
    is_stale_.fill_zero();
    count_blocked(0);
    Counts counts = read_counts();
    if (counts.out_of_bounds > 0) {
        parallel_for(space_, "collision/widen_known", x.size(),
                     WidenKnown{marks_.view(), displacement_.view(), slack_, known()});
        count_blocked(find_near_marked(counts.out_of_bounds));
        counts = read_counts();
    }
    return counts.blocked == 0 ? View<const BlockedPair>() : list_blocked();
}

View<const BlockedPair> DeviceCollisionFreeStep::update(View<const ChangedTrajectory> changed)
{
    const View<ChangedTrajectory> sent = first_items(host_changed_, changed.size());
    std::copy(changed.begin(), changed.end(), sent.begin());
    changed_.upload(sent);
    is_stale_.fill_zero();
    marks_.fill_zero();
    parallel_sum(space_, "collision/device_record_changed", changed.size(), 0,
                 RecordChanged{changed_.view(), slack_, known(), displacement_.view(), is_stale_.view(),
                               marks_.view()},
                 counts_.view().subview(0, 1), block_sums_);
    int first_new = count_;
    if (const int out_of_bounds = read_counts().out_of_bounds; out_of_bounds > 0)
        first_new = find_near_marked(out_of_bounds);
    count_blocked(first_new);
    return list_blocked();
}

/// Appends the pairs of marked vertices, or replaces all since begin(): is_search_complete().
/// @param count  of marked vertices
/// @return the first of the appended pairs
int DeviceCollisionFreeStep::find_near_marked(int count)
{
    const StageScope stage("collision/search_again");
    const int vertices = marks_.size();
    const bool is_complete = is_search_complete(count, vertices, count_, complete_count_);
    if (is_complete) {
        count = vertices;
        count_ = expected_count_;
        parallel_for(space_, "collision/recentre_known", vertices,
                     RecentreKnown{displacement_.view(), slack_, known(), marks_.view()});
    }
    const int first = count_;
    const Trajectories trajectories{known_motion_.view(), known_radius_.view(), marks_.view()};
    exempt_.append_kept(near_.find_near(base_, trajectories, count, gap_.largest()), pairs_, count_);
    if (is_complete)
        complete_count_ = count_;
    return first;
}

/// @param known  pairs before this one are tested only if they have a stale vertex
void DeviceCollisionFreeStep::count_blocked(int known)
{
    if (is_blocked_.size() < count_)
        is_blocked_.resize_keeping(pairs_.size());
    parallel_sum(space_, "collision/device_blocked", count_, 0,
                 CountBlocked{pairs_.view().subview(0, count_),
                              {base_, displacement_.view(), gap_},
                              is_stale_.view(),
                              known,
                              is_blocked_.view().subview(0, count_)},
                 counts_.view().subview(1, 1), block_sums_);
}

DeviceCollisionFreeStep::Counts DeviceCollisionFreeStep::read_counts()
{
    space_.synchronise();
    return {counts_[0], counts_[1]};
}

/// Lists the blocked pairs on the host.
View<const BlockedPair> DeviceCollisionFreeStep::list_blocked()
{
    const int number = list_flagged(space_, "collision/device_list_blocked",
                                    is_blocked_.view().subview(0, count_), indices_, listed_, scratch_);
    const View<BlockedPair> read = first_items(host_blocked_, number);
    parallel_for(space_, "collision/device_report_blocked", number,
                 ReportBlocked{pairs_.view().subview(0, count_),
                               {base_, displacement_.view(), gap_},
                               indices_.view(),
                               first_items(blocked_, number)});
    blocked_.download_first(read);
    space_.synchronise();
    return read;
}

} // namespace toile::collision
