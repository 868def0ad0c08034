#include "collision/self/cuda/exempt_pairs.h"

#include <algorithm>

#include "collision/body/cuda/pair_kernels.h"
#include "collision/self/cuda/exempt_kernels.h"
#include "core/compute/copy_items.h"
#include "core/compute/cuda/parallel.cuh"

namespace toile::collision {

namespace {

/// Capacity relative to the needed size [-].
constexpr double kHeadroom = 1.25;

bool any(View<const unsigned char> marks) { return std::find(marks.begin(), marks.end(), 1) != marks.end(); }

} // namespace

DeviceExemptPairs::DeviceExemptPairs(const CudaSpace& space, const ExemptPairs& exempt)
    : space_(space), exempt_(exempt), too_near_(exempt.rule().too_near), rest_(space, "exempt_pairs/rest"),
      is_thin_(space, "exempt_pairs/is_thin"), crosses_(space, "exempt_pairs/crosses"),
      inside_(space, "exempt_pairs/inside"), released_(space, "exempt_pairs/released"),
      crossings_(space, "exempt_pairs/crossings"), owner_normal_(space, "exempt_pairs/owner_normal"),
      body_normal_(space, "exempt_pairs/body_normal"), marks_(space, "exempt_pairs/marks"),
      indices_(space, "exempt_pairs/indices"), count_(space, "exempt_pairs/count", 1),
      scratch_(space, "exempt_pairs/scratch")
{
    rest_.upload(exempt.rule().rest);
    is_thin_.upload(exempt.rule().is_thin);
}

/// Copies what has changed on the host.
void DeviceExemptPairs::follow()
{
    if (revision_ == exempt_.revision())
        return;
    revision_ = exempt_.revision();
    const ExemptRule now = exempt_.rule();
    crosses_.upload(now.crosses);
    crossings_.upload(now.body_crossings);
    inside_.upload(now.inside);
    released_.upload(now.lets_through);
    owner_normal_.upload(now.owner_normal);
    body_normal_.upload(now.body_normal);
    may_exempt_ = any(now.is_thin) || any(now.crosses) || !now.body_crossings.empty() ||
                  !now.inside.empty() || !now.lets_through.empty();
}

void DeviceExemptPairs::append_kept(View<const NearPair> found, DeviceArray<NearPair>& kept, int& count)
{
    follow();
    const int max_count = count + found.size();
    if (max_count > kept.size()) {
        kept.resize_keeping(count); // items beyond count are not in use
        kept.resize_keeping(int(kHeadroom * double(max_count)));
    }
    const View<NearPair> rest = kept.view().subview(count, found.size());
    if (!may_exempt_) {
        parallel_for(space_, "collision/device_keep_pairs", found.size(), CopyItems<NearPair>{found, rest});
        count = max_count;
        return;
    }

    marks_.resize(found.size());
    parallel_for(space_, "collision/device_mark_kept", found.size(), MarkKept{rule(), found, marks_.view()});
    const int number =
        list_flagged(space_, "collision/device_list_kept", marks_.view(), indices_, count_, scratch_);
    parallel_for(space_, "collision/device_keep_pairs", number,
                 CopyListed<NearPair>{found, indices_.view(), rest});
    count += number;
}

} // namespace toile::collision
