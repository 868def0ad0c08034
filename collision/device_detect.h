#pragma once

#include <memory>
#include <vector>

#include "collision/detect.h"
#include "collision/device_detect_report.h"
#include "collision/device_mesh_collider.h"
#include "collision/device_shape_kernels.h"
#include "core/backend/cuda/event.h"
#include "core/backend/cuda/scan.h"

namespace toile {

/// SideMemory on a GPU: which sheets of moving meshes each cloth vertex is in front of.
class DeviceSideMemory {
public:
    DeviceSideMemory(const CudaSpace& space, int vertex_count);

    /// Enqueues: nothing is remembered.
    void forget();

    View<VertexSides> sides() { return sides_.view(); } ///< [vertices]
    View<const VertexSides> sides() const { return sides_.view(); }

private:
    DeviceArray<VertexSides> sides_;
};

/// ContactDetector on a GPU: the same pairs in the same order; numbers differ from the CPU's in
/// last bits, and so may a pair whose test is within rounding of its limit. The same bits in every run.
/// Positions and pairs stay on the device.
///
/// Cloth vertices look for planes, cloth triangles for vertices of the mesh and cloth edges for ridges, a
/// thread each, and keep numbers in slots of their own; sums of counts give the pairs' places.
class DeviceContactDetector {
public:
    /// @param space      borrowed
    /// @param triangles  [triangles x 3] the cloth's, of the host
    /// @param positions  [vertices x 3] any pose of it, e.g. the first [m], of the host
    /// @param room       pairs that there is room for at first; 0: three per vertex
    /// @throws DeviceError where the device has not the memory
    DeviceContactDetector(const CudaSpace& space, View<const Triangle> triangles, View<const Vec3> positions,
                          int room = 0);

    /// Cloth positions to detect at and how far, on the device, borrowed until the next move, as
    /// ContactDetector has them. Drops all pairs.
    /// @param settings  of the detect() that follow; no reach may be above its radius
    void move(View<const Vec3> x, View<const double> reach, const DetectSettings& settings);

    /// Appends the pairs against one mesh as ContactDetector::detect does; returns those, on the device until
    /// the next call. Waits for their number. Where there was not enough room it grows and searches again.
    /// @param sides      may be null
    /// @param clearance  [vertices] see Clearance::of, of the device [m]: vertices that are clear by more
    ///                   than they look for are not looked for; may be empty
    /// @throws DeviceError where the device has not the memory
    View<const ContactPair> detect(const DeviceMeshCollider& mesh, int collider,
                                   const DeviceSideMemory* sides = nullptr,
                                   View<const double> clearance = {});

    /// The same against a solid.
    View<const ContactPair> detect(const ShapeCollider& shape, int collider);

    /// detect() in two parts, of which the first can be recorded in a graph: enqueues a search with the room
    /// that there is.
    void search(const DeviceMeshCollider& mesh, int collider, const DeviceSideMemory* sides = nullptr,
                View<const double> clearance = {});
    void search(const ShapeCollider& shape, int collider);
    /// Waits. False where there was not enough room: it has grown, and the same search, recorded anew, finds
    /// all pairs; else these are appended.
    bool settle();

    /// Those of all colliders since the last move.
    View<const ContactPair> pairs() const { return pairs_.view().subview(0, count_); }
    /// How far in front of the mesh of the last search each vertex is [m], at least; 0: inside, negative: it
    /// was not looked for.
    const DeviceArray<double>& in_front() const { return in_front_; }
    /// Copies them into `out` [pairs().size()], before the call returns.
    void download(View<ContactPair> out) const { pairs_.download_first(out); }

    /// Enqueues: SideMemory::learn at positions x [vertices] [m] of the device, for a mesh that has ever
    /// moved.
    /// @param clearance  as detect()'s, at x
    void learn_sides(View<const Vec3> x, const DeviceMeshCollider& mesh, int collider,
                     DeviceSideMemory& sides, View<const double> clearance = {});

    /// The parts of search(), for whoever times them. None needs what another finds: planes and ridges go to
    /// the stream of `on`.
    void find_planes(const CudaSpace& on, const DeviceMeshCollider& mesh, int collider,
                     const DeviceSideMemory* sides = nullptr, View<const double> clearance = {});
    void find_sheets(const DeviceMeshCollider& mesh, int collider);
    void find_ridges(const CudaSpace& on, const DeviceMeshCollider& mesh, int collider);
    void report(const DeviceMeshCollider& mesh, int collider);

private:
    /// Slots of queries that have more or less items.
    struct SlotArrays {
        SlotArrays(const CudaSpace& space, const std::string& name, int query_count)
            : queries(query_count), items(space, name + "_items"), found(space, name + "_found"),
              most(space, name + "_most", 1), sums(space, name + "_sums")
        {
        }
        Slots slots() { return {items.view(), queries}; }

        int queries, room = 4;           ///< room: items of a query
        DeviceArray<int> items, found;   ///< [room x queries], [queries + 1]; the last stays 0
        DeviceArray<Largest> most, sums; ///< of found
    };

    DeviceSearch search_of(const DeviceMeshCollider& mesh, int collider) const;
    View<int> nearest_of(int collider);
    void clear_counts();
    View<int> counts_of_vertices() { return counts_.view().subview(0, x_.size()); }
    View<int> counts_of_sheets() { return counts_.view().subview(x_.size(), sheet_room_); }
    View<int> counts_of_ridges() { return counts_.view().subview(x_.size() + sheet_room_, ridges_.queries); }
    PairPlaces places() const { return {first_.view(), x_.size(), sheet_room_}; }
    void measure(SlotArrays& slots);
    template <typename Solid>
    void search_solid(const ShapeRules<Solid>& rules);
    template <ShapeQuery Query, typename Solid>
    void count_pairs(const ShapeRules<Solid>& rules, int begin, int queries);
    template <ShapeQuery Query, typename Solid>
    void report_pairs(const ShapeRules<Solid>& rules, int begin, int queries);

    const CudaSpace& space_;
    CudaSpace beside_;           ///< for planes and ridges, while sheets are found
    StreamEvent begun_, joined_; ///< of a search: before it goes apart, and what beside_ has done
    DeviceSurface cloth_;        ///< its trees tell who lies beside whom, their boxes are not renewed
    DeviceArray<int> order_;     ///< [vertices] along a curve through the first pose
    DeviceArray<int> rank_;      ///< [triangles] ranks_by_corners
    View<const Vec3> x_;
    View<const double> reach_;
    DetectSettings settings_;
    std::vector<std::unique_ptr<DeviceArray<int>>> nearest_; ///< by collider, [vertices] triangles

    DeviceArray<int> planes_; ///< [3 x vertices]
    SlotArrays sheets_, ridges_;
    /// [vertices + room for sheets, or triangles where there is a solid, + edges + 1]; the last stays 0
    DeviceArray<int> counts_;
    DeviceArray<long> first_;       ///< their sums
    DeviceArray<long> first_sheet_; ///< [triangles + 1] sums of what they have found
    DeviceArray<double> distance_;  ///< [vertices] to a solid's skeleton [m]
    DeviceArray<double> in_front_;  ///< [vertices] see in_front()
    SortArrays sort_;
    DeviceArray<int> sorted_sheets_;
    int sheet_room_; ///< sheets that there is room for
    DeviceArray<ContactPair> pairs_;
    int count_ = 0, last_count_ = 0;     ///< of pairs: all, and those of the last search
    PinnedArray<DetectNumbers> numbers_; ///< [1]
    DeviceScratch scratch_;
};

} // namespace toile
