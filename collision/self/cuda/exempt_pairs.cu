#include "collision/self/cuda/exempt_pairs.h"

#include <algorithm>

#include "collision/body/cuda/pair_kernels.h"
#include "collision/self/cuda/exempt_kernels.h"
#include "core/compute/cuda/parallel.cuh"

namespace toile::collision {

namespace {

/// Capacity relative to the needed size [-].
constexpr double kHeadroom = 1.25;

} // namespace

DeviceExemptPairs::DeviceExemptPairs(const CudaSpace& space, const ExemptPairs& exempt)
    : space_(space), rest_(space, "exempt_pairs/rest"), too_near_(exempt.rule().too_near),
      is_thin_(space, "exempt_pairs/is_thin"), crosses_(space, "exempt_pairs/crosses"),
      has_thin_(any(exempt.rule().is_thin)), marks_(space, "exempt_pairs/marks"),
      indices_(space, "exempt_pairs/indices"), count_(space, "exempt_pairs/count", 1),
      scratch_(space, "exempt_pairs/scratch")
{
    rest_.upload(exempt.rule().rest);
    is_thin_.upload(exempt.rule().is_thin);
    set_crossing(exempt.rule().crosses);
}

bool DeviceExemptPairs::any(View<const unsigned char> marks)
{
    return std::find(marks.begin(), marks.end(), 1) != marks.end();
}

void DeviceExemptPairs::set_crossing(View<const unsigned char> crosses)
{
    crosses_.upload(crosses);
    has_crossing_ = any(crosses);
}

void DeviceExemptPairs::append_kept(View<const NearPair> found, DeviceArray<NearPair>& kept, int& count)
{
    const int max_count = count + found.size();
    if (max_count > kept.size()) {
        kept.resize_keeping(count); // items beyond count are not in use
        kept.resize_keeping(int(kHeadroom * double(max_count)));
    }
    const View<NearPair> rest = kept.view().subview(count, found.size());
    if (!has_thin_ && !has_crossing_) {
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
