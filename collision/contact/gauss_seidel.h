#pragma once

/// Kernels that project terms one after the other; see GaussSeidelState.

#include <array>
#include <cmath>

#include "collision/contact/projections.h"
#include "core/compute/gauss_seidel.h"
#include "core/compute/shared_bounds.h"

namespace toile::collision {

/// Finds the maximum depth of active terms at each vertex; for term i.
template <typename Projection>
struct FindDeepest {
    Projection projection;
    View<const ContactTerm> terms;
    View<float> deepest; ///< [vertices] [m] out; 0 before

    TOILE_HD void operator()(int i) const
    {
        const double depth = projection.depth(i, terms[i]);
        if (depth <= 0.0)
            return;
        for (const int v : terms[i].pair.vertex)
            if (v >= 0)
                raise_shared(deepest[v], float(depth));
    }
};

/// Flags the slot of term i if it is active or may be moved deeper; for i in [0, slot_count()), as slots
/// beyond the terms are empty.
template <typename Projection>
struct FlagActive {
    Projection projection;
    View<const ContactTerm> terms;
    GaussSeidelSchedule order;
    View<const float> deepest; ///< see FindDeepest; unused without kPropagates
    View<unsigned char> flags; ///< [slots] out

    TOILE_HD void operator()(int i) const
    {
        flags[order.slot_of(i)] = i < order.count && is_scheduled(i, terms[i]) ? 1 : 0;
    }

private:
    TOILE_HD bool is_scheduled(int i, const ContactTerm& term) const
    {
        const double depth = projection.depth(i, term);
        if (!Projection::kPropagates)
            return depth > 0.0;
        if (depth > -kSurelyOut)
            return true;
        float others = 0.0F;
        for (const int v : term.pair.vertex)
            if (v >= 0)
                others = std::fmax(others, deepest[v]);
        return -depth < std::fmin(kPropagationFactor * others, kMaxPropagation);
    }
};

/// Projection of a listed term on copies of its vertices' fields: local[f][k] is field f at its vertex k. The
/// vertices of the prepared pair are therefore 0 to 3, or -1 if unused.
template <typename Projection>
struct ProjectScheduledTerm {
    static constexpr int kFields = Projection::kFields;

    Projection projection;
    View<const ContactTerm> terms;

    struct Prepared {
        PreparedTerm local_term;   ///< prepared with the numbers below, then renumbered
        std::array<int, 4> vertex; ///< numbers in the fields
    };

    TOILE_HD SharedFields<kFields> fields() const { return projection.fields(); }
    TOILE_HD Prepared prepare(int i) const
    {
        Prepared prepared{projection.prepare(terms[i]), terms[i].pair.vertex};
        std::array<int, 4>& vertex = prepared.local_term.term.pair.vertex;
        for (int k = 0; k < 4; ++k)
            vertex[k] = vertex[k] < 0 ? -1 : k;
        return prepared;
    }
    TOILE_HD std::array<int, 4> shared(const Prepared& prepared) const { return prepared.vertex; }
    TOILE_HD void operator()(int i, const Prepared& prepared, LocalFields<kFields>& local) const
    {
        SharedFields<kFields> local_fields;
        for (int f = 0; f < kFields; ++f)
            local_fields[f] = View<Vec3>(local[f].data(), 4);
        projection.over(local_fields)(i, prepared.local_term);
    }
};

/// Vertices of a term, which it shares with others.
struct VerticesOfTerm {
    View<const ContactTerm> terms;
    TOILE_HD std::array<int, 4> operator()(int i) const { return terms[i].pair.vertex; }
};

} // namespace toile::collision
