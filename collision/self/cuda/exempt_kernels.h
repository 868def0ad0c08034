#pragma once

#include "collision/self/exempt_pairs.h"

namespace toile::collision {

/// Marks the pairs that are not exempt.
struct MarkKept {
    ExemptRule rule;
    View<const NearPair> found;
    View<unsigned char> marks; ///< [found] out
    TOILE_HD void operator()(int i) const { marks[i] = (unsigned char)(rule.is_exempt(found[i]) ? 0 : 1); }
};

} // namespace toile::collision
