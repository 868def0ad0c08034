#include "collision/contact/cuda/energy.h"

#include <algorithm>
#include <limits>

#include "collision/contact/cuda/contact_kernels.h"
#include "core/compute/cuda/teams.cuh"

namespace toile::collision {

namespace {

/// Capacity relative to the needed size [-].
constexpr double kHeadroom = 1.25;

/// Threads that share the terms of a vertex.
constexpr int kListThreads = 8;

} // namespace

DeviceContactEnergy::DeviceContactEnergy(const CudaSpace& space)
    : space_(space), terms_(space, "contact/terms"), vertices_(space, "contact/vertices"),
      first_(space, "contact/first"), entries_(space, "contact/entries"), list_of_(space, "contact/list_of"),
      force_(space, "contact/force"), term_energy_(space, "contact/energy"), frozen_(space, "contact/frozen"),
      blocks_(space, "contact/blocks"), product_(space, "contact/product"),
      active_count_(space, "contact/active_count"), rows_(space, "contact/rows"), sort_(space),
      flags_(space, "contact/flags"), count_(space, "contact/count", 1), scratch_(space, "contact/scratch")
{
}

View<ContactTerm> DeviceContactEnergy::reserve(int count)
{
    if (count > capacity_)
        capacity_ = int(std::min(kHeadroom * count, double(std::numeric_limits<int>::max() / 4 - 1)));
    for (const int size : {capacity_, count}) {
        terms_.resize(size);
        force_.resize(size);
        term_energy_.resize(size);
        frozen_.resize(size);
        sort_.resize(4 * size);
        entries_.resize(4 * size);
        rows_.resize(4 * size);
        flags_.resize(4 * size + 1);
        first_.resize(4 * size + 1);
    }
    return terms_.view();
}

void DeviceContactEnergy::set_terms(View<const ContactTerm> terms, int vertex_count)
{
    reserve(terms.size());
    terms_.upload(terms);
    build_incidence(vertex_count);
}

void DeviceContactEnergy::build_incidence(int vertex_count)
{
    vertices_.resize(0);
    if (!has_terms())
        return;
    const View<std::uint64_t> keys = sort_.keys.view();
    parallel_for(space_, "contact/key_incidence", keys.size(),
                 KeyIncidence{terms_.view(), keys, sort_.values.view()});
    sort_by_key(space_, "contact/sort_incidence", sort_, entries_.view(), key_bits(vertex_count));
    parallel_for(space_, "contact/flag_lists", flags_.size(),
                 FlagLists{sort_.sorted_keys.view(), flags_.view()});
    const int lists =
        list_flagged(space_, "contact/list_incidence", flags_.view(), first_, count_, scratch_) - 1;
    vertices_.resize(lists);
    blocks_.resize(lists);
    product_.resize(lists);
    active_count_.resize(lists);
    list_of_.resize(vertex_count);
    list_of_.fill_zero();
    parallel_for(space_, "contact/number_lists", lists,
                 NumberList{first_.view(), sort_.sorted_keys.view(), vertices_.view(), list_of_.view()});
}

void DeviceContactEnergy::evaluate(View<const Vec3> x, View<Vec3> gradient, View<double> energy)
{
    parallel_for(space_, "contact/evaluate", terms_.size(),
                 EvaluateAndFreeze{{terms_.view(), x, force_.view(), term_energy_.view()},
                                   {terms_.view(), x, has_true_hessian_, frozen_.view()}});
    parallel_for_teams<kListThreads>(space_, "contact/gather", vertices_.size(),
                                     GatherContact{incidence(), vertices_.view(), force_.view(),
                                                   term_energy_.view(), frozen_.view(), gradient, energy,
                                                   blocks_.view(), rows()});
}

FrozenRows DeviceContactEnergy::rows() const { return {first_.view(), active_count_.view(), rows_.view()}; }

void DeviceContactEnergy::multiply(View<const PaddedVec3> p)
{
    parallel_for_teams<kListThreads>(space_, "contact/multiply", vertices_.size(),
                                     MultiplyList{rows(), p, product_.view()});
}

DeviceActiveSet::Frozen DeviceContactEnergy::frozen() const
{
    return {list_of_.view(), vertices_.view(), rows(), blocks_.view(), product_.view()};
}

} // namespace toile::collision
