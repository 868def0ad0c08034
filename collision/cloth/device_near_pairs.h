#pragma once

#include "collision/cloth/device_around_kernels.h"
#include "collision/device_surface.h"
#include "core/backend/cuda/event.h"
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

    /// Pairs with one of some vertices that now go elsewhere than find() was asked for: those that may come
    /// nearer than `margin` on their ways, and some more as there, in the same order. Where these are few
    /// nothing but their surroundings is looked at. Vertices of no triangle have none. Waits for their
    /// number; a later kernel of another stream must wait for the pairs.
    /// @param x       as find() was given, with what it held
    /// @param ways    none empty; `around` marks the vertices. All others go as in the searches since find()
    /// @param count   of vertices that are marked
    /// @param margin  [m] no larger than in find()
    View<const NearPair> find_around(View<const Vec3> x, const Ways& ways, int count, double margin);

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

    /// The parts of search(), one after the other, for whoever times them: search() does edges beside
    /// vertices.
    void refit(View<const Vec3> x, const Ways& ways, double margin) { surface_.move(x, ways, margin); }
    void count_triangles();
    void count_edges() { count_edges_on(space_); }
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

    void search_begun();
    void count_edges_on(const CudaSpace& on);
    void list_candidates();
    void list_pairs(View<const Record> candidates, View<const long> first, View<const SoupExtent> extent,
                    View<const Vec3> x, const Ways& ways, double margin, DeviceScratch& scratch);
    void search_around_few(View<const Vec3> x, const Ways& ways, int count, double margin);
    bool settle_around();
    void report_sorted(int count, View<const Vec3> x);
    View<const Triangle> triangles() const { return surface_.triangles(); }
    SurfaceEdgesView edges() const { return surface_.edges(); }
    void make_room(long candidates, long pairs);

    const CudaSpace& space_;
    CudaSpace beside_;           ///< for edges, while vertices look for triangles
    StreamEvent placed_, found_; ///< of a search: before it goes apart, and what beside_ has done
    DeviceSurface surface_;
    DeviceArray<int> rigid_;
    Asked begun_;    ///< by begin()
    Asked recorded_; ///< by begin() before, with the memory that there is
    bool is_recorded_ = false;
    CudaGraph graph_;
    double ordered_surface_ = 0.0; ///< [m^2] of the first search after the order was chosen; 0: none yet
    bool is_worn_out_ = false;

    DeviceArray<int> counts_; ///< [vertices + edges + 1] candidates; the last stays 0
    DeviceArray<long> first_; ///< [vertices + edges + 1] their sums
    DeviceArray<int> kept_for_vertices_, kept_for_edges_;
    DeviceArray<int> around_, around_counts_; ///< vertices of find_around(), candidates of its teams
    DeviceArray<long> around_first_;          ///< sums of that
    int room_around_ = 0;                     ///< candidates that there is room for around few vertices
    SortArrays sort_;
    DeviceArray<int> sorted_;
    DeviceArray<Record> candidates_;
    DeviceArray<unsigned char> is_pair_;
    DeviceArray<int> pairs_in_list_, count_; ///< [candidates], [1]
    DeviceArray<NearPair> pairs_;
    PinnedArray<SearchNumbers> numbers_; ///< [1]
    DeviceScratch scratch_;
    DeviceScratch around_scratch_; ///< may grow without the recorded search
};

} // namespace toile
