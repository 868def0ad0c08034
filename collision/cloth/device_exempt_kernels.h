#pragma once

#include "collision/cloth/exempt_pairs.h"

namespace toile {

/// Marks the pairs that are not exempt.
struct MarkKept {
    ExemptRule rule;
    View<const NearPair> found;
    View<unsigned char> marks; ///< [found] out
    TOILE_HD void operator()(int i) const { marks[i] = (unsigned char)(rule.is_exempt(found[i]) ? 0 : 1); }
};

} // namespace toile
