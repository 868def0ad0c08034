#pragma once

/// What terms on a GPU are asked during a step.

#include <limits>

#include "collision/contact_kernels.h"
#include "collision/contact_rules.h"

namespace toile {

/// Flags terms.
struct FlagLeaning {
    ContactLook look;
    ContactRules rules;
    View<unsigned char> flags; ///< [terms] out
    TOILE_HD void operator()(int i) const { flags[i] = look.is_leaning(i, rules) ? 1 : 0; }
};

struct FlagSlid {
    ContactLook look;
    ContactRules rules;
    View<const Vec3> found_at; ///< [vertices] [m]
    double trust;              ///< [m]
    View<unsigned char> flags; ///< [terms] out
    TOILE_HD void operator()(int i) const { flags[i] = look.has_slid(i, rules, found_at, trust) ? 1 : 0; }
};

/// Marks the vertex of list k where one of its terms is flagged.
struct MarkFlagged {
    ContactTouches touches;
    View<const int> vertices;        ///< [lists]
    View<const unsigned char> flags; ///< [terms]
    View<unsigned char> marks;       ///< [vertices] set to 1
    TOILE_HD void operator()(int k) const
    {
        for (int e = touches.first[k]; e < touches.first[k + 1]; ++e)
            if (flags[touches.entries[e] / 4] != 0)
                marks[vertices[k]] = 1;
    }
};

/// The least or largest of terms, as a sum.
struct Least {
    double value = std::numeric_limits<double>::infinity();
    TOILE_HD Least& operator+=(const Least& other)
    {
        value = other.value < value ? other.value : value;
        return *this;
    }
};

struct LeastDistance {
    ContactLook look;
    TOILE_HD Least operator()(int i) const { return {look.terms[i].pair.gap(look.x)}; }
};

/// The largest depth in colliders, negative.
struct LeastHeight {
    ContactLook look;
    TOILE_HD Least operator()(int i) const
    {
        return {look.terms[i].pair.is_between_cloths() ? 0.0 : -look.depth(i)};
    }
};

} // namespace toile
