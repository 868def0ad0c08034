#pragma once

#include "collision/cloth/device_near_pairs.h"
#include "core/backend/cuda/mark.h"

namespace toile {

/// Searches for near pairs on a stream of their own: what another stream is given meanwhile runs beside them.
class NearPairsBeside {
public:
    /// @param space  the other stream, borrowed
    /// @param triangles, positions, rigid  as DeviceNearPairs has them
    NearPairsBeside(const CudaSpace& space, View<const Triangle> triangles, View<const Vec3> positions,
                    View<const int> rigid = {})
        : beside_(space.device().index, space.checks()), given_(space),
          near_(beside_, triangles, positions, rigid)
    {
    }

    /// Begins a search, as DeviceNearPairs, once all is done that the other stream has been given. What is
    /// given to it from now on must leave these arrays as they are until end().
    void begin(View<const Vec3> x, const Ways& ways, double margin)
    {
        given_.set();
        given_.hold_back(beside_);
        near_.begin(x, ways, margin);
    }

    /// Waits for the pairs, which stay until the next search.
    View<const NearPair> end() { return near_.end(); }

    View<const NearPair> find(View<const Vec3> x, const Ways& ways, double margin)
    {
        begin(x, ways, margin);
        return end();
    }

    SoupView soup() const { return near_.soup(); }

private:
    CudaSpace beside_;
    StreamMark given_; ///< all that the other stream was given before a search
    DeviceNearPairs near_;
};

} // namespace toile
