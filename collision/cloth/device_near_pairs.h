#pragma once

#include "collision/cloth/device_near_kernels.h"
#include "collision/device_surface.h"
#include "core/backend/cuda/graph.h"

namespace toile {

/// NearPairs on a GPU: the same pairs in the same order, as NearPair in double precision; numbers differ from
/// the CPU's in last bits, and so may a pair whose test is within rounding of its limit. The same bits in
/// every run. Positions, ways and pairs stay on the device.
///
/// Every vertex looks for triangles and every edge for edges of a larger number, a thread each. Candidates
/// are counted, given their places by a sum, sorted by number within a query, tested, and the pairs among
/// them reported, a thread each. The time of sorting grows with the square of the candidates of one query.
class DeviceNearPairs {
public:
    /// @param space      borrowed
    /// @param triangles, positions, rigid  as NearPairs has them, of the host; not needed afterwards
    /// @param room       pairs that there is room for at first; 0: two per vertex
    /// @throws DeviceError where the device has not the memory
    DeviceNearPairs(const CudaSpace& space, View<const Triangle> triangles, View<const Vec3> positions,
                    View<const int> rigid = {}, int room = 0);

    /// All pairs as NearPairs::find has them, on the device until the next search. Waits for their number.
    /// Where there was not enough room it grows and searches again; where the order of the trees was worn out
    /// by the search before, it is chosen anew. What is asked for again, of the same arrays, goes to the
    /// device as one graph.
    /// @param x, ways  on the device
    /// @throws DeviceError where the device has not the memory, or there are 2^31 candidates
    View<const NearPair> find(View<const Vec3> x, const Ways& ways, double margin)
    {
        begin(x, ways, margin);
        return end();
    }
    /// The same in two calls: begins a search, and waits for what it finds. What was given stays as it is
    /// until then.
    void begin(View<const Vec3> x, const Ways& ways, double margin);
    View<const NearPair> end();

    /// Copies the first pairs that find() has found into `out`, before the call returns.
    void download(View<NearPair> out) const { pairs_.download_first(out); }

    /// find() for who records it in a graph: enqueues a search with the room that there is.
    void search(View<const Vec3> x, const Ways& ways, double margin);
    /// Waits. False where there was not enough room: it has grown, and the same search, recorded anew, finds
    /// all pairs.
    bool settle();
    /// What search() leaves, for kernels after it: pairs [room] and their number [1], where that is not above
    /// the room.
    View<const NearPair> pairs() const { return pairs_.view(); }
    View<const int> count() const { return count_.view(); }

    SoupView soup() const { return {surface_.triangles(), surface_.edges()}; } ///< on the device

    /// The parts of search(), for whoever times them.
    void refit(View<const Vec3> x, const Ways& ways, double margin) { surface_.move(x, ways, margin); }
    void count_triangles();
    void count_edges();
    void report(View<const Vec3> x, const Ways& ways, double margin);

private:
    VertexQueries vertex_queries() const;
    EdgeQueries edge_queries() const;
    PairCorners corners() const { return {surface_.triangles(), surface_.edges().vertex}; }

    struct Asked {
        View<const Vec3> x;
        Ways ways;
        double margin = 0.0;

        bool is(const Asked& other) const
        {
            const auto are_same = [](const auto& a, const auto& b) {
                return a.data() == b.data() && a.size() == b.size();
            };
            return are_same(x, other.x) && are_same(ways.motion, other.ways.motion) &&
                   are_same(ways.slack, other.ways.slack) && are_same(ways.around, other.ways.around) &&
                   margin == other.margin;
        }
    };

    /// What search() was asked for last, and its recording.
    struct Recording {
        explicit Recording(const CudaSpace& space) : graph(space, "collision/device_search") {}

        Asked asked;
        bool is_recorded = false;
        CudaGraph graph;
    };

    void search_begun();
    void list_candidates();
    void make_room(long candidates, long pairs);

    const CudaSpace& space_;
    DeviceSurface surface_;
    DeviceArray<int> rigid_;
    Asked begun_;                  ///< by begin()
    Recording all_, around_;       ///< of begin(): without and with Ways::around
    double ordered_surface_ = 0.0; ///< [m^2] of the first search after the order was chosen; 0: none yet
    bool is_worn_out_ = false;

    DeviceArray<int> counts_; ///< [vertices + edges + 1] candidates; the last stays 0
    DeviceArray<long> first_; ///< [vertices + edges + 1] their sums
    DeviceArray<int> kept_for_vertices_, kept_for_edges_;
    DeviceArray<Record> candidates_;
    DeviceArray<unsigned char> is_pair_;
    DeviceArray<int> pairs_in_list_, count_; ///< [candidates], [1]
    DeviceArray<NearPair> pairs_;
    PinnedArray<SearchNumbers> numbers_; ///< [1]
    DeviceScratch scratch_;
};

} // namespace toile
