#include "collision/contact/cuda/memory.h"

#include "core/compute/cuda/grown_array.h"
#include "core/compute/cuda/parallel.cuh"

namespace toile::collision {

DeviceContactMemory::DeviceContactMemory(const CudaSpace& space)
    : space_(space), records_(space, "memory/records"), hashes_(space), order_(space, "memory/order"),
      flags_(space, "memory/flags"), pressing_(space, "memory/pressing"), count_(space, "memory/count", 1),
      scratch_(space, "memory/scratch")
{
}

void DeviceContactMemory::keep(View<const ContactTerm> terms, const ContactRules& rules, RememberedSlip slip,
                               View<const Vec3> x)
{
    const View<unsigned char> flags = first_items(flags_, terms.size());
    parallel_for(space_, "contact/flag_pressing", terms.size(), FlagPressing{terms, flags});
    const int count = list_flagged(space_, "contact/list_pressing", flags, pressing_, count_, scratch_);
    records_.resize(count);
    hashes_.resize(count);
    order_.resize(count);
    parallel_for(space_, "contact/remember", count,
                 RememberTerm{terms, rules, slip, x, pressing_.view(), records_.view(), hashes_.keys.view(),
                              hashes_.values.view()});
    sort_by_key(space_, "contact/sort_memory", hashes_, order_.view());
}

} // namespace toile::collision
