#pragma once

/// Queries of terms on a GPU during a step.

#include <limits>

#include "collision/contact/kernels.h"
#include "collision/contact/rules.h"

namespace toile::collision {

/// Flags terms that support cloth; see ContactQuery.
struct FlagSupported {
    ContactQuery query;
    ContactRules rules;
    View<unsigned char> flags; ///< [terms] out
    TOILE_HD void operator()(int i) const { flags[i] = query.is_supported(i, rules) ? 1 : 0; }
};

/// Flags terms that press.
struct FlagTouching {
    ContactQuery query;
    View<unsigned char> flags; ///< [terms] out
    TOILE_HD void operator()(int i) const { flags[i] = query.terms[i].gap(query.x) < 0.0 ? 1 : 0; }
};

struct FlagSlid {
    ContactQuery query;
    ContactRules rules;
    View<const Vec3> found_at; ///< [vertices] [m]
    double trust;              ///< [m]
    View<unsigned char> flags; ///< [terms] out
    TOILE_HD void operator()(int i) const { flags[i] = query.has_slid(i, rules, found_at, trust) ? 1 : 0; }
};

/// Marks the vertex of list k where one of its terms is flagged.
struct MarkFlagged {
    ContactIncidence incidence;
    View<const int> vertices;        ///< [lists]
    View<const unsigned char> flags; ///< [terms]
    View<unsigned char> marks;       ///< [vertices] set to 1
    TOILE_HD void operator()(int k) const
    {
        for (int e = incidence.first[k]; e < incidence.first[k + 1]; ++e)
            if (flags[incidence.entries[e] / 4] != 0)
                marks[vertices[k]] = 1;
    }
};

/// Minimum over terms, as a sum.
struct Smallest {
    double value = std::numeric_limits<double>::infinity();
    TOILE_HD Smallest& operator+=(const Smallest& other)
    {
        value = other.value < value ? other.value : value;
        return *this;
    }
};

struct MinDistance {
    ContactQuery query;
    TOILE_HD Smallest operator()(int i) const { return {query.terms[i].pair.gap(query.x)}; }
};

/// Negative depth of a term in colliders.
struct MinHeight {
    ContactQuery query;
    TOILE_HD Smallest operator()(int i) const
    {
        return {query.terms[i].pair.is_between_cloths() ? 0.0 : -query.depth(i)};
    }
};

} // namespace toile::collision
