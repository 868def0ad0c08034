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

/// Copies marked pairs behind each other.
struct KeepMarked {
    View<const NearPair> found;
    View<const int> places; ///< [found] those of marked pairs
    View<NearPair> kept;    ///< [marked] out
    TOILE_HD void operator()(int i) const { kept[i] = found[places[i]]; }
};

/// Copies all.
struct KeepAll {
    View<const NearPair> found;
    View<NearPair> kept; ///< [found] out
    TOILE_HD void operator()(int i) const { kept[i] = found[i]; }
};

} // namespace toile
