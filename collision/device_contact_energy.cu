#include "collision/device_contact_energy.h"

#include <algorithm>
#include <limits>

#include "collision/device_contact_kernels.h"
#include "core/backend/cuda/teams.cuh"

namespace toile {

namespace {

/// Room is made for this much more than was needed [-].
constexpr double kHeadroom = 1.25;

/// Threads that share the terms of a vertex.
constexpr int kListThreads = 8;

} // namespace

DeviceContactEnergy::DeviceContactEnergy(const CudaSpace& space)
    : space_(space), terms_(space, "contact/terms"), vertices_(space, "contact/vertices"),
      first_(space, "contact/first"), entries_(space, "contact/entries"), list_of_(space, "contact/list_of"),
      force_(space, "contact/force"), term_energy_(space, "contact/energy"), frozen_(space, "contact/frozen"),
      blocks_(space, "contact/blocks"), product_(space, "contact/product"),
      acting_count_(space, "contact/acting_count"), acting_entries_(space, "contact/acting_entries"),
      sort_(space), flags_(space, "contact/flags"), count_(space, "contact/count", 1),
      scratch_(space, "contact/scratch")
{
}

View<ContactTerm> DeviceContactEnergy::make_room(int count)
{
    if (count > room_)
        room_ = int(std::min(kHeadroom * count, double(std::numeric_limits<int>::max() / 4 - 1)));
    for (const int size : {room_, count}) {
        terms_.resize(size);
        force_.resize(size);
        term_energy_.resize(size);
        frozen_.resize(size);
        sort_.resize(4 * size);
        entries_.resize(4 * size);
        acting_entries_.resize(4 * size);
        flags_.resize(4 * size + 1);
        first_.resize(4 * size + 1);
    }
    return terms_.view();
}

void DeviceContactEnergy::set_terms(View<const ContactTerm> terms, int vertex_count)
{
    make_room(terms.size());
    terms_.upload(terms);
    touch(vertex_count);
}

void DeviceContactEnergy::touch(int vertex_count)
{
    vertices_.resize(0);
    if (!has_terms())
        return;
    const View<std::uint64_t> keys = sort_.keys.view();
    parallel_for(space_, "contact/key_touches", keys.size(),
                 KeyTouch{terms_.view(), keys, sort_.values.view()});
    sort_by_key(space_, "contact/sort_touches", sort_, entries_.view(), key_bits(vertex_count));
    parallel_for(space_, "contact/flag_lists", flags_.size(),
                 FlagLists{sort_.sorted_keys.view(), flags_.view()});
    const int lists =
        list_flagged(space_, "contact/list_touched", flags_.view(), first_, count_, scratch_) - 1;
    vertices_.resize(lists);
    blocks_.resize(lists);
    product_.resize(lists);
    acting_count_.resize(lists);
    list_of_.resize(vertex_count);
    list_of_.fill_zero();
    parallel_for(space_, "contact/number_lists", lists,
                 NumberList{first_.view(), sort_.sorted_keys.view(), vertices_.view(), list_of_.view()});
}

void DeviceContactEnergy::evaluate(View<const Vec3> x, View<Vec3> gradient, View<double> energy)
{
    parallel_for(space_, "contact/evaluate", terms_.size(),
                 EvaluateAndFreeze{{terms_.view(), x, force_.view(), term_energy_.view()},
                                   {terms_.view(), x, frozen_.view()}});
    parallel_for_teams<kListThreads>(space_, "contact/gather", vertices_.size(),
                                     GatherContact{touches(), vertices_.view(), force_.view(),
                                                   term_energy_.view(), frozen_.view(), gradient, energy,
                                                   blocks_.view(), acting_there()});
}

ActingEntries DeviceContactEnergy::acting_there()
{
    return {first_.view(), acting_count_.view(), acting_entries_.view()};
}

void DeviceContactEnergy::multiply(View<const PaddedVec3> p)
{
    parallel_for_teams<kListThreads>(space_, "contact/multiply", vertices_.size(),
                                     MultiplyList{acting_there(), p, product_.view()});
}

DeviceActiveSet::Frozen DeviceContactEnergy::frozen() const
{
    return {list_of_.view(), vertices_.view(), acting_count_.view(), blocks_.view(), product_.view()};
}

} // namespace toile
