#pragma once

#include "collision/self/cuda/near_pairs.h"
#include "core/compute/cuda/runtime/event.h"

namespace toile::collision {

/// Searches for near pairs on a separate stream, concurrent with the work of another stream.
class AsyncNearPairs {
public:
    /// @param space  the other stream, borrowed
    /// @param triangles, positions, rigid  see DeviceNearPairs
    AsyncNearPairs(const CudaSpace& space, View<const Triangle> triangles, View<const Vec3> positions,
                   View<const int> rigid = {})
        : space_(space), beside_(space, CudaSpace::Beside{}), given_(space), found_(beside_),
          near_(beside_, triangles, positions, rigid)
    {
    }

    /// Begins a search, as DeviceNearPairs, after all work enqueued so far on the other stream. Work enqueued
    /// on it later must not change these arrays until end().
    void begin(View<const Vec3> x, const Trajectories& trajectories, double margin)
    {
        TOILE_ASSERT(!is_searching_);
        given_.record();
        given_.delay(beside_);
        near_.begin(x, trajectories, margin);
        is_searching_ = true;
    }

    /// Waits for the pairs, which stay valid until the next search.
    View<const NearPair> end()
    {
        TOILE_ASSERT(is_searching_);
        is_searching_ = false;
        return near_.end();
    }

    /// Waits for a search that was begun and will not be ended; does nothing if there is none.
    void abandon()
    {
        if (is_searching_)
            beside_.synchronise();
        is_searching_ = false;
    }

    /// Runs DeviceNearPairs::find_near after all work enqueued so far on the other stream and before its
    /// later work.
    View<const NearPair> find_near(View<const Vec3> x, const Trajectories& trajectories, int count,
                                   double margin)
    {
        TOILE_ASSERT(!is_searching_);
        given_.record();
        given_.delay(beside_);
        const View<const NearPair> pairs = near_.find_near(x, trajectories, count, margin);
        found_.record();
        found_.delay(space_);
        return pairs;
    }

    SoupView soup() const { return near_.soup(); }
    void set_limited(bool is_limited) { near_.set_limited(is_limited); } ///< see DeviceNearPairs

private:
    const CudaSpace& space_;
    CudaSpace beside_;
    StreamEvent given_; ///< work of the other stream before a search
    StreamEvent found_; ///< last find_near()
    DeviceNearPairs near_;
    bool is_searching_ = false;
};

} // namespace toile::collision
