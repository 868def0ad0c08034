#pragma once

#include "core/backend/cuda/array.h"

namespace toile {

/// The first `count` items of an array, a DeviceArray or a PinnedArray, whose size is the room that it has: a
/// quarter more than was asked where it grows, so that lists whose lengths vary ask for memory in few steps.
/// What was there is forgotten then.
template <typename Array>
auto first_items(Array& array, int count)
{
    if (array.size() < count)
        array.resize(count + count / 4);
    return array.view().subview(0, count);
}

} // namespace toile
