#pragma once

#include <memory>
#include <vector>

#include "core/compute/types.h"

namespace toile {
template <typename T>
class Readback;
} // namespace toile

namespace toile::scenes {

/// Positions of all surfaces of a World at one sample. May be read later, on any thread, while the World
/// continues; copies from a GPU may still be in progress.
class Snapshot {
public:
    /// Positions of a surface, numbered as World::surfaces() [vertices] [m]. Waits for them.
    /// @throws DeviceError if the GPU no longer responds, InvalidUse for a surface that does not exist
    View<const Vec3> positions(int surface) const;

    /// Adds a surface. @param positions  copied
    void add(View<const Vec3> positions);
    /// Adds a surface whose positions are elements [first, first + count) of a readback in progress.
    void add(std::shared_ptr<const Readback<Vec3>> coming, int first, int count);

private:
    struct Surface {
        std::shared_ptr<const Readback<Vec3>> coming; ///< null: copied
        int first, count;
        std::vector<Vec3> copied;
    };
    std::vector<Surface> surfaces_;
};

} // namespace toile::scenes
