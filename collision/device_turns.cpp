#include "collision/device_turns.h"

#include "core/backend/cuda/roomy.h"

namespace toile {

DeviceTurns::DeviceTurns(const CudaSpace& space, int vertex_count)
    : space_(space), vertex_count_(vertex_count), flags_(space, "turns/flags"),
      places_(space, "turns/places"), count_(space, "turns/count", 1), rank_(space, "turns/rank"),
      passed_(space, "turns/passed"), next_(space, "turns/next"), deepest_(space, "turns/deepest"),
      scratch_(space, "turns/scratch")
{
}

/// Nothing has begun.
Turns DeviceTurns::make_room(const DeviceContactEnergy& contact, int sweeps, int fields)
{
    const TurnOrder order{contact.terms().size()};
    next_.resize(sweeps);
    next_.fill_zero();
    first_items(flags_, order.place_count());
    return {order,
            first_items(places_, order.place_count()),
            count_.view(),
            first_items(rank_, Turns::kShares * order.count),
            first_items(passed_, fields * vertex_count_),
            next_.view()};
}

} // namespace toile
