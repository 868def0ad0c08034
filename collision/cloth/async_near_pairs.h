#pragma once

#include "collision/cloth/device_near_pairs.h"
#include "core/backend/cuda/event.h"

namespace toile {

/// Searches for near pairs on a stream of their own: what another stream is given meanwhile runs beside them.
class AsyncNearPairs {
public:
    /// @param space  the other stream, borrowed
    /// @param triangles, positions, rigid  as DeviceNearPairs has them
    AsyncNearPairs(const CudaSpace& space, View<const Triangle> triangles, View<const Vec3> positions,
                   View<const int> rigid = {})
        : space_(space), beside_(space, CudaSpace::Beside{}), given_(space), found_(beside_),
          near_(beside_, triangles, positions, rigid)
    {
    }

    /// Begins a search, as DeviceNearPairs, once all is done that the other stream has been given. What is
    /// given to it from now on must leave these arrays as they are until end().
    void begin(View<const Vec3> x, const Ways& ways, double margin)
    {
        TOILE_ASSERT(!is_searching_);
        given_.record();
        given_.delay(beside_);
        near_.begin(x, ways, margin);
        is_searching_ = true;
    }

    /// Waits for the pairs, which stay until the next search.
    View<const NearPair> end()
    {
        TOILE_ASSERT(is_searching_);
        is_searching_ = false;
        return near_.end();
    }

    /// Waits for a search that was begun and that nobody ends any more; there may be none.
    void abandon()
    {
        if (is_searching_)
            beside_.synchronise();
        is_searching_ = false;
    }

    /// As DeviceNearPairs, after all that the other stream has been given and before what it is given next.
    View<const NearPair> find_around(View<const Vec3> x, const Ways& ways, int count, double margin)
    {
        TOILE_ASSERT(!is_searching_);
        given_.record();
        given_.delay(beside_);
        const View<const NearPair> pairs = near_.find_around(x, ways, count, margin);
        found_.record();
        found_.delay(space_);
        return pairs;
    }

    SoupView soup() const { return near_.soup(); }

private:
    const CudaSpace& space_;
    CudaSpace beside_;
    StreamEvent given_; ///< all that the other stream was given before a search
    StreamEvent found_; ///< the last search around vertices
    DeviceNearPairs near_;
    bool is_searching_ = false;
};

} // namespace toile
