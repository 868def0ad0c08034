#include "collision/host_turns.h"

#include "core/backend/parallel.h"

namespace toile {

void HostTurns::list(View<const ContactTerm> terms, View<Vec3> x, double margin)
{
    terms_ = terms;
    x_ = x;
    start_.resize(x.size());
    listed_.clear();
    const TurnOrder order{terms.size()};
    flags_.resize(order.place_count());
    parallel_for(kCpu, "contact/flag_near", order.place_count(), FlagNear{terms, x, margin, order, flags_});
    for (int place = 0; place < order.place_count(); ++place) {
        if (flags_[place] == 0)
            continue;
        const int i = order.at(place);
        listed_.push_back(i);
        for (int k = 0; k < terms[i].pair.count(); ++k)
            start_[terms[i].pair.vertex[k]] = x[terms[i].pair.vertex[k]];
    }
}

void HostTurns::put_back()
{
    for (const int i : listed_)
        for (int k = 0; k < terms_[i].pair.count(); ++k)
            x_[terms_[i].pair.vertex[k]] = start_[terms_[i].pair.vertex[k]];
}

} // namespace toile
