#include "collision/device_turns.h"

#include "core/backend/cuda/roomy.h"

namespace toile {

DeviceTurns::DeviceTurns(const CudaSpace& space, int vertex_count)
    : space_(space), vertex_count_(vertex_count), flags_(space, "turns/flags"),
      places_(space, "turns/places"), count_(space, "turns/count", 1), rank_(space, "turns/rank"),
      passed_(space, "turns/passed"), next_(space, "turns/next"), deepest_(space, "turns/deepest"),
      moved_(space, "turns/moved", 1), moved_here_(space, "turns/moved_here", 1),
      scratch_(space, "turns/scratch")
{
}

/// Nothing has begun, nothing is deep, and nothing moved.
Turns DeviceTurns::make_room(const DeviceContactEnergy& contact, int sweeps, int fields)
{
    const TurnOrder order{contact.terms().size()};
    next_.resize(sweeps);
    next_.fill_zero();
    deepest_.resize(sweeps * vertex_count_);
    deepest_.fill_zero();
    moved_.fill_zero();
    first_items(flags_, order.place_count());
    return {order,
            first_items(places_, order.place_count()),
            count_.view(),
            first_items(rank_, Turns::kShares * order.count),
            first_items(passed_, fields * vertex_count_),
            next_.view()};
}

bool DeviceTurns::moved()
{
    moved_.download(moved_here_.view());
    space_.synchronise();
    return moved_here_[0] != 0;
}

} // namespace toile
