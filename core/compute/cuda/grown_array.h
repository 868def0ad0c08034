#pragma once

#include "core/compute/cuda/array.h"

namespace toile {

/// View of the first `count` items of a DeviceArray or PinnedArray whose size is its capacity. An array that
/// is too small grows to a quarter more than asked and loses its contents. Lists of varying length then
/// allocate rarely.
template <typename Array>
auto first_items(Array& array, int count)
{
    if (array.size() < count)
        array.resize(count + count / 4);
    return array.view().subview(0, count);
}

} // namespace toile
