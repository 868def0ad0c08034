#pragma once

#include <memory>
#include <vector>

#include "core/backend/cuda/readback.h"

namespace toile {

/// Where the surfaces of a World are at one sample, for whoever reads that later, on any thread, while World
/// goes on. What a GPU has may still be on its way.
class Snapshot {
public:
    /// Positions of a surface, numbered as World::surfaces() [vertices] [m]. Waits for them.
    /// @throws DeviceError where the GPU no longer answers
    View<const Vec3> positions(int surface) const;

    /// Adds a surface. @param positions  copied
    void add(View<const Vec3> positions);
    /// The same of which vertices [first, first + count) of what comes are the positions.
    void add(std::shared_ptr<const Readback<Vec3>> coming, int first, int count);

private:
    struct Surface {
        std::shared_ptr<const Readback<Vec3>> coming; ///< null: copied
        int first, count;
        std::vector<Vec3> copied;
    };
    std::vector<Surface> surfaces_;
};

} // namespace toile
