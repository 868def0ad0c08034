#include "scenes/world/snapshot.h"

#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/compute/cuda/readback.h"

namespace toile::scenes {

View<const Vec3> Snapshot::positions(int surface) const
{
    if (surface < 0 || surface >= int(surfaces_.size()))
        throw InvalidUse("Snapshot::positions(" + std::to_string(surface) + "): there are " +
                         std::to_string(surfaces_.size()) + " surfaces");
    const Surface& asked = surfaces_[size_t(surface)];
    if (!asked.coming)
        return asked.copied;
    return asked.coming->await().subview(asked.first, asked.count);
}

void Snapshot::add(View<const Vec3> positions)
{
    surfaces_.push_back({nullptr, 0, positions.size(), {positions.begin(), positions.end()}});
}

void Snapshot::add(std::shared_ptr<const Readback<Vec3>> coming, int first, int count)
{
    surfaces_.push_back({std::move(coming), first, count, {}});
}

} // namespace toile::scenes
