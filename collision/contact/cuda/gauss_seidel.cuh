#pragma once

/// Sweeps of DeviceGaussSeidel. Included by .cu files, like parallel.cuh.

#include "collision/contact/cuda/gauss_seidel.h"
#include "collision/contact/gauss_seidel.h"
#include "core/compute/cuda/gauss_seidel.cuh"

namespace toile::collision {

template <typename Projection>
void DeviceGaussSeidel::sweep(const DeviceContactEnergy& contact, const Projection& projection, int sweeps)
{
    const View<const ContactTerm> terms = contact.terms();
    for ([[maybe_unused]] const View<Vec3>& field : projection.fields())
        TOILE_ASSERT(field.size() == vertex_count_);
    GaussSeidelState state = make_schedule(contact, sweeps, Projection::kFields);
    const View<unsigned char> flags = flags_.view().subview(0, state.slots.size());
    if constexpr (Projection::kPropagates) {
        deepest_.resize(sweeps * vertex_count_);
        deepest_.fill_zero();
    }
    for (int done = 0; done < sweeps; ++done) {
        state.next = next_.view().subview(done, 1);
        View<float> deepest;
        if constexpr (Projection::kPropagates) {
            deepest = deepest_.view().subview(done * vertex_count_, vertex_count_);
            parallel_for(space_, "contact/find_deepest", terms.size(),
                         FindDeepest<Projection>{projection, terms, deepest});
        }
        parallel_for(space_, "contact/flag_active", flags.size(),
                     FlagActive<Projection>{projection, terms, state.order, deepest, flags});
        list_flagged(space_, "contact/list_active", flags, slots_.view().subview(0, flags.size()),
                     count_.view(), scratch_);
        parallel_for(space_, "contact/assign_ranks", GaussSeidelState::kSharedSlots * terms.size(),
                     AssignGaussSeidelRank<VerticesOfTerm, Projection::kFields>{
                         state, {terms}, flags, contact.lists(), projection.fields(), rank_.view()});
        parallel_gauss_seidel(space_, "contact/project", state, terms.size(),
                              ProjectScheduledTerm<Projection>{projection, terms});
    }
}

} // namespace toile::collision
