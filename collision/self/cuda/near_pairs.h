#pragma once

#include "collision/geometry/cuda/surface.h"
#include "collision/self/cuda/nearby_kernels.h"
#include "core/base/error.h"
#include "core/compute/cuda/runtime/event.h"
#include "core/compute/cuda/runtime/graph.h"

namespace toile::collision {

/// Trajectories sweep through each other, with more candidates than a search lists. Shorter ones have fewer.
class TooManyPairs : public DeviceError {
public:
    using DeviceError::DeviceError;
};

/// NearPairs on a GPU: the same pairs in the same order, in double precision. Numbers differ from the CPU's
/// in the last bits, and so may the presence of a pair within rounding of a limit. Every run gives the same
/// bits. Positions, trajectories and pairs stay on the device.
///
/// One thread per vertex searches for triangles, one per edge for edges with a larger number. Candidates are
/// counted, listed at offsets from a prefix sum, and tested. One thread per pair completes it and sorts it by
/// number within its query. The time of this sort grows with the square of the pairs of one query.
class DeviceNearPairs {
public:
    /// @param space      borrowed
    /// @param triangles, positions, rigid  see NearPairs, on the host; not needed afterwards
    /// @param capacity       initial capacity in pairs; 0: two per vertex
    /// @throws DeviceError if the device lacks the memory
    DeviceNearPairs(const CudaSpace& space, View<const Triangle> triangles, View<const Vec3> positions,
                    View<const int> rigid = {}, int capacity = 0);

    /// Finds the pairs of NearPairs::find, on the device until the next search. Waits for their number. If
    /// the capacity is too small, it grows and the search is repeated. If the last search has worn out the
    /// order of the trees, a new one is chosen. A repeated search of the same arrays is launched as one
    /// graph.
    /// @param x, trajectories  on the device
    /// @throws TooManyPairs, DeviceError if the device lacks the memory
    View<const NearPair> find(View<const Vec3> x, const Trajectories& trajectories, double margin)
    {
        begin(x, trajectories, margin);
        return end();
    }
    /// Splits find() in two calls: begin() starts a search, end() waits for its pairs. The arguments must not
    /// change in between.
    void begin(View<const Vec3> x, const Trajectories& trajectories, double margin);
    View<const NearPair> end();

    /// Finds the pairs of vertices whose trajectories have changed since find(): those that may come nearer
    /// than `margin`, and some more as in find(), in the same order. If the vertices are few, only their
    /// surroundings are searched. Vertices without triangles have no pairs. Waits for the number of pairs; a
    /// later kernel of another stream must wait for the pairs.
    /// @param x       as in find(), unchanged
    /// @param trajectories    all fields given; `selected` marks the vertices. All others move as in the
    ///                        searches since find()
    /// @param count   number of marked vertices
    /// @param margin  [m] no larger than in find()
    /// @throws as find()
    View<const NearPair> find_near(View<const Vec3> x, const Trajectories& trajectories, int count,
                                   double margin);

    /// Whether searches throw TooManyPairs (default). Otherwise only memory limits them.
    void set_limited(bool is_limited) { is_limited_ = is_limited; }

    /// Copies the first pairs of find() into `out`, before the call returns.
    void download(View<NearPair> out) const { pairs_.download_first(out); }

    /// Variant of find() for recording in a graph: enqueues a search with the current capacity.
    void search(View<const Vec3> x, const Trajectories& trajectories, double margin);
    /// Waits. False if the capacity was too small: it has grown, and the same search, recorded anew, finds
    /// all pairs. @throws TooManyPairs
    bool complete();
    /// Results of search() for later kernels: pairs [capacity] and their number [1], valid if it is not above
    /// the capacity.
    View<const NearPair> pairs() const { return pairs_.view(); }
    View<const int> count() const { return count_.view(); }

    SoupView soup() const { return {surface_.triangles(), surface_.edges()}; } ///< on the device

    /// Parts of search() in sequence, for timing; search() itself runs edges concurrently with vertices.
    void refit(View<const Vec3> x, const Trajectories& trajectories, double margin)
    {
        surface_.move(x, trajectories, margin);
    }
    void count_triangles();
    void count_edges() { count_edges_on(space_); }
    void report(View<const Vec3> x, const Trajectories& trajectories, double margin);

private:
    VertexQueries vertex_queries() const;
    EdgeQueries edge_queries() const;
    PairCorners corners() const { return {surface_.triangles(), surface_.edges().vertex}; }

    struct Asked {
        View<const Vec3> x;
        Trajectories trajectories;
        double margin = 0.0;

        bool is(const Asked& other) const
        {
            const auto are_same = [](const auto& a, const auto& b) {
                return a.data() == b.data() && a.size() == b.size();
            };
            return are_same(x, other.x) && are_same(trajectories.motion, other.trajectories.motion) &&
                   are_same(trajectories.slack, other.trajectories.slack) &&
                   are_same(trajectories.selected, other.trajectories.selected) && margin == other.margin;
        }
    };

    void require_few(long candidates) const;
    void search_begun();
    void count_edges_on(const CudaSpace& on);
    void list_candidates();
    void list_pairs(View<const Record> candidates, View<const long> first, View<const SoupExtent> extent,
                    View<const Vec3> x, const Trajectories& trajectories, double margin,
                    DeviceScratch& scratch);
    void search_near_few(View<const Vec3> x, const Trajectories& trajectories, int count, double margin);
    bool complete_near();
    void report_sorted(int count, View<const Vec3> x);
    View<const Triangle> triangles() const { return surface_.triangles(); }
    SurfaceEdgesView edges() const { return surface_.edges(); }
    void reserve(long candidates, long pairs);

    const CudaSpace& space_;
    CudaSpace beside_;           ///< stream of the edge search, concurrent with that of vertices
    StreamEvent placed_, found_; ///< fork to beside_ and join of a search
    DeviceSurface surface_;
    DeviceArray<int> rigid_;
    Asked begun_;    ///< by begin()
    Asked recorded_; ///< by the begin() before, with the current memory
    bool is_recorded_ = false;
    CudaGraph graph_;
    double ordered_surface_ = 0.0; ///< [m^2] in the first search after the order was chosen; 0: none yet
    bool is_worn_out_ = false;
    bool is_limited_ = true;

    DeviceArray<int> counts_; ///< [vertices + edges + 1] candidates; the last stays 0
    DeviceArray<long> first_; ///< [vertices + edges + 1] offsets, sums of counts_
    DeviceArray<int> kept_for_vertices_, kept_for_edges_;
    DeviceArray<int> near_vertices_, near_counts_; ///< vertices of find_near(), candidates of its teams
    DeviceArray<long> near_first_;                 ///< offsets, sums of near_counts_
    int near_capacity_ = 0;                        ///< capacity for candidates of few vertices
    SortArrays sort_;
    DeviceArray<int> sorted_;
    DeviceArray<Record> candidates_;
    DeviceArray<unsigned char> is_pair_;
    DeviceArray<int> pairs_in_list_, count_; ///< [candidates], [1]
    DeviceArray<NearPair> pairs_;
    PinnedArray<SearchNumbers> numbers_; ///< [1]
    DeviceScratch scratch_;
    DeviceScratch near_scratch_; ///< may grow without a new recording
};

} // namespace toile::collision
