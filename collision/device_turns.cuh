#pragma once

/// What DeviceTurns runs. Included by .cu files, as parallel.cuh.

#include "collision/contact_turns.h"
#include "collision/device_turns.h"
#include "core/backend/cuda/turns.cuh"

namespace toile {

template <typename Push>
void DeviceTurns::sweep(const DeviceContactEnergy& contact, const Push& push, int sweeps)
{
    const View<const ContactTerm> terms = contact.terms();
    for ([[maybe_unused]] const View<Vec3>& field : push.fields())
        TOILE_ASSERT(field.size() == vertex_count_);
    Turns turns = make_room(contact, sweeps, Push::kFields);
    const View<unsigned char> flags = flags_.view().subview(0, turns.places.size());
    if constexpr (Push::kCarries) {
        deepest_.resize(sweeps * vertex_count_);
        deepest_.fill_zero();
    }
    for (int done = 0; done < sweeps; ++done) {
        turns.next = next_.view().subview(done, 1);
        View<float> deepest;
        if constexpr (Push::kCarries) {
            deepest = deepest_.view().subview(done * vertex_count_, vertex_count_);
            parallel_for(space_, "contact/find_deepest", terms.size(),
                         FindDeepest<Push>{push, terms, deepest});
        }
        parallel_for(space_, "contact/flag_acting", flags.size(),
                     FlagActing<Push>{push, terms, turns.order, deepest, flags});
        list_flagged(space_, "contact/list_acting", flags, places_.view().subview(0, flags.size()),
                     count_.view(), scratch_);
        parallel_for(space_, "contact/number_turns", Turns::kShares * terms.size(),
                     NumberTurn<VerticesOfTerm, Push::kFields>{
                         turns, {terms}, flags, contact.lists(), push.fields(), rank_.view()});
        parallel_in_turns(space_, "contact/push", turns, terms.size(), PushInTurn<Push>{push, terms});
    }
}

} // namespace toile
