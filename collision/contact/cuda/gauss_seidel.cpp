#include "collision/contact/cuda/gauss_seidel.h"

#include "core/compute/cuda/grown_array.h"

namespace toile::collision {

DeviceGaussSeidel::DeviceGaussSeidel(const CudaSpace& space, int vertex_count)
    : space_(space), vertex_count_(vertex_count), flags_(space, "gauss_seidel/flags"),
      slots_(space, "gauss_seidel/slots"), count_(space, "gauss_seidel/count", 1),
      rank_(space, "gauss_seidel/rank"), passed_(space, "gauss_seidel/passed"),
      next_(space, "gauss_seidel/next"), deepest_(space, "gauss_seidel/deepest"),
      scratch_(space, "gauss_seidel/scratch")
{
}

/// State in which no sweep has begun.
GaussSeidelState DeviceGaussSeidel::make_schedule(const DeviceContactEnergy& contact, int sweeps, int fields)
{
    const GaussSeidelSchedule order{contact.terms().size()};
    next_.resize(sweeps);
    next_.fill_zero();
    first_items(flags_, order.slot_count());
    return {order,
            first_items(slots_, order.slot_count()),
            count_.view(),
            first_items(rank_, GaussSeidelState::kSharedSlots * order.count),
            first_items(passed_, fields * vertex_count_),
            next_.view()};
}

} // namespace toile::collision
