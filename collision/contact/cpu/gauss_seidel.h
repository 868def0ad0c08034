#pragma once

#include <vector>

#include "collision/contact/gauss_seidel.h"
#include "core/compute/parallel.h"

namespace toile::collision {

/// Projection of terms one after the other, in their GaussSeidelSchedule, on the CPU.
class CpuGaussSeidel {
public:
    /// Sweeps over the terms that are active when a sweep begins or may be moved deeper, until there are none
    /// or nothing moves.
    /// @return whether something moved
    template <typename Projection>
    bool sweep(View<const ContactTerm> terms, const Projection& projection, int sweeps)
    {
        bool moved = false;
        for (int done = 0; done < sweeps; ++done) {
            bool moves = false;
            list(terms, projection);
            for (const int i : listed_)
                moves |= projection(i, projection.prepare(terms[i]));
            if (!moves)
                break;
            moved = true;
        }
        return moved;
    }

private:
    template <typename Projection>
    void list(View<const ContactTerm> terms, const Projection& projection)
    {
        const GaussSeidelSchedule order{terms.size()};
        flags_.resize(order.slot_count());
        if (Projection::kPropagates) {
            deepest_.assign(projection.fields()[0].size(), 0.0F);
            parallel_for(kCpu, "contact/find_deepest", order.count,
                         FindDeepest<Projection>{projection, terms, deepest_});
        }
        parallel_for(kCpu, "contact/flag_active", order.slot_count(),
                     FlagActive<Projection>{projection, terms, order, deepest_, flags_});
        listed_.clear();
        for (int slot = 0; slot < order.slot_count(); ++slot)
            if (flags_[slot] != 0)
                listed_.push_back(order.at(slot));
    }

    std::vector<float> deepest_;       ///< [vertices] see FindDeepest
    std::vector<unsigned char> flags_; ///< [slots]
    std::vector<int> listed_;          ///< terms, in order
};

} // namespace toile::collision
