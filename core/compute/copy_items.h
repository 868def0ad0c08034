#pragma once

#include "core/compute/types.h"

namespace toile {

/// Copies all items.
template <typename T>
struct CopyItems {
    View<const T> from;
    View<T> to;
    TOILE_HD void operator()(int i) const { to[i] = from[i]; }
};

} // namespace toile
