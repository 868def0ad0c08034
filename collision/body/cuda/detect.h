#pragma once

#include <memory>
#include <vector>

#include "collision/body/cuda/detect_report.h"
#include "collision/body/cuda/mesh_collider.h"
#include "collision/body/cuda/shape_kernels.h"
#include "collision/body/detect.h"
#include "core/compute/cuda/runtime/event.h"
#include "core/compute/cuda/scan.h"

namespace toile::collision {

/// ContactSideHistory on a GPU: the sheets of moving meshes that each cloth vertex is in front of.
class DeviceContactSideHistory {
public:
    DeviceContactSideHistory(const CudaSpace& space, int vertex_count);

    /// Enqueues a reset to no sheets.
    void forget();

    View<VertexSides> sides() { return sides_.view(); } ///< [vertices]
    View<const VertexSides> sides() const { return sides_.view(); }

private:
    DeviceArray<VertexSides> sides_;
};

/// ContactDetector on a GPU: the same pairs in the same order, with the same bits in every run. Numbers
/// differ from the CPU's in last bits, and so may a pair whose test is within rounding of its limit.
/// Positions and pairs stay on the device.
///
/// One thread per cloth vertex searches planes, one per cloth triangle mesh vertices, one per cloth edge
/// ridges. Each writes feature numbers to its own slots; prefix sums of counts give the indices of the pairs.
class DeviceContactDetector {
public:
    /// @param space      borrowed
    /// @param triangles  [triangles x 3] the cloth's, on the host
    /// @param positions  [vertices x 3] any pose of it, e.g. the first [m], on the host
    /// @param capacity   initial capacity in pairs; 0: three per vertex
    /// @throws DeviceError if the device lacks memory
    DeviceContactDetector(const CudaSpace& space, View<const Triangle> triangles, View<const Vec3> positions,
                          int capacity = 0);

    /// Sets cloth positions and reach as ContactDetector::move does, on the device, borrowed until the next
    /// move. Drops all pairs.
    /// @param settings  of the following detect() calls; no reach may exceed its radius
    void move(View<const Vec3> x, View<const double> reach, const DetectSettings& settings);

    /// Appends the pairs against one mesh as ContactDetector::detect does. Waits for their number. If the
    /// capacity was too small, it grows and the search repeats.
    /// @param sides      may be null
    /// @param clearance  [vertices] see Clearance::of, on the device [m]: skips vertices with a clearance
    ///                   above their search radius; may be empty
    /// @return the appended pairs, on the device until the next call
    /// @throws DeviceError if the device lacks memory
    View<const ContactPair> detect(const DeviceMeshCollider& mesh, int collider,
                                   const DeviceContactSideHistory* sides = nullptr,
                                   View<const double> clearance = {});

    /// Appends the pairs against a solid.
    View<const ContactPair> detect(const ShapeCollider& shape, int collider);

    /// Parts of detect(): search() can be recorded in a graph and enqueues a search with the present
    /// capacity.
    void search(const DeviceMeshCollider& mesh, int collider, const DeviceContactSideHistory* sides = nullptr,
                View<const double> clearance = {});
    void search(const ShapeCollider& shape, int collider);
    /// Completes a search. True appends its pairs; false means that the capacity was too small and has grown.
    /// The same search, recorded anew, then finds all pairs. Waits.
    bool complete();

    /// Pairs of all colliders since the last move.
    View<const ContactPair> pairs() const { return pairs_.view().subview(0, count_); }
    /// Lower bound on each vertex's distance in front of the mesh of the last search [m]. 0: inside;
    /// negative: not searched.
    const DeviceArray<double>& in_front() const { return in_front_; }
    /// Copies the pairs into `out` [pairs().size()] before it returns.
    void download(View<ContactPair> out) const { pairs_.download_first(out); }

    /// Enqueues ContactSideHistory::update at positions x [vertices] [m] on the device, for a mesh that has
    /// moved at least once.
    /// @param clearance  as in detect(), at x
    void update_sides(View<const Vec3> x, const DeviceMeshCollider& mesh, int collider,
                      DeviceContactSideHistory& sides, View<const double> clearance = {});

    /// Parts of search(), separate for timing. They are independent: planes and ridges run on the stream of
    /// `on`.
    void find_planes(const CudaSpace& on, const DeviceMeshCollider& mesh, int collider,
                     const DeviceContactSideHistory* sides = nullptr, View<const double> clearance = {});
    void find_sheets(const DeviceMeshCollider& mesh, int collider);
    void find_ridges(const CudaSpace& on, const DeviceMeshCollider& mesh, int collider);
    void report(const DeviceMeshCollider& mesh, int collider);

private:
    /// Slots of queries with a varying number of items.
    struct SlotArrays {
        SlotArrays(const CudaSpace& space, const std::string& name, int query_count)
            : queries(query_count), items(space, name + "_items"), found(space, name + "_found"),
              max_found(space, name + "_max", 1), sums(space, name + "_sums")
        {
        }
        Slots slots() { return {items.view(), queries}; }

        int queries, capacity = 4;            ///< capacity: items per query
        DeviceArray<int> items, found;        ///< [capacity x queries], [queries + 1]; the last is 0
        DeviceArray<Largest> max_found, sums; ///< of found
    };

    DeviceSearch search_of(const DeviceMeshCollider& mesh, int collider) const;
    View<int> nearest_of(int collider);
    void clear_counts();
    View<int> counts_of_vertices() { return counts_.view().subview(0, x_.size()); }
    View<int> counts_of_sheets() { return counts_.view().subview(x_.size(), sheet_capacity_); }
    View<int> counts_of_ridges()
    {
        return counts_.view().subview(x_.size() + sheet_capacity_, ridges_.queries);
    }
    PairSlots pair_slots() const { return {first_.view(), x_.size(), sheet_capacity_}; }
    void measure(SlotArrays& slots);
    template <typename Solid>
    void search_solid(const ShapeRules<Solid>& rules);
    template <ShapeQuery Query, typename Solid>
    void count_pairs(const ShapeRules<Solid>& rules, int begin, int queries);
    template <ShapeQuery Query, typename Solid>
    void report_pairs(const ShapeRules<Solid>& rules, int begin, int queries);

    const CudaSpace& space_;
    CudaSpace beside_;           ///< for planes and ridges, concurrent with sheets
    StreamEvent begun_, joined_; ///< of a search: before the fork, and the end of beside_
    DeviceSurface cloth_;        ///< its trees only order neighbours; their boxes are not refitted
    DeviceArray<int> order_;     ///< [vertices] along a curve through the first pose
    DeviceArray<int> rank_;      ///< [triangles] ranks_by_corners
    View<const Vec3> x_;
    View<const double> reach_;
    DetectSettings settings_;
    std::vector<std::unique_ptr<DeviceArray<int>>> nearest_; ///< [colliders] [vertices] triangles

    DeviceArray<int> planes_; ///< [3 x vertices]
    SlotArrays sheets_, ridges_;
    /// [vertices + sheet capacity, or triangles with a solid, + edges + 1]; the last is 0
    DeviceArray<int> counts_;
    DeviceArray<long> first_;       ///< prefix sums of counts_
    DeviceArray<long> first_sheet_; ///< [triangles + 1] prefix sums of the sheets' counts
    DeviceArray<double> distance_;  ///< [vertices] to a solid's skeleton [m]
    DeviceArray<double> in_front_;  ///< [vertices] see in_front()
    SortArrays sort_;
    DeviceArray<int> sorted_sheets_;
    int sheet_capacity_; ///< capacity in sheets
    DeviceArray<ContactPair> pairs_;
    int count_ = 0, last_count_ = 0;     ///< number of pairs: all, and of the last search
    PinnedArray<DetectNumbers> numbers_; ///< [1]
    DeviceScratch scratch_;
};

} // namespace toile::collision
