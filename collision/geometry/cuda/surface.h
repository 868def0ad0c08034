#pragma once

#include "collision/geometry/cuda/surface_kernels.h"
#include "collision/geometry/surface_edges.h"
#include "core/compute/cuda/array.h"
#include "core/compute/cuda/sort.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::collision {

/// Moving triangle soup on a GPU: its incidences, and box trees over its triangles and its edges. The trees
/// have no pointers. Their items follow a Hilbert curve through a pose that is chosen rarely; searches only
/// refit the boxes.
class DeviceSurface {
public:
    /// @param triangles  [triangles x 3] indices into positions; any list: collapsed, non-manifold
    /// @param positions  [vertices x 3] [m] first pose, on the host
    /// @param passive    [vertices] 1: pairs of primitives of such vertices are not visited; empty: all are
    DeviceSurface(const CudaSpace& space, View<const Triangle> triangles, View<const Vec3> positions,
                  View<const unsigned char> passive = {});

    /// Enqueues a refit around the straight trajectories of all vertices. As in Candidates::update, the mean
    /// motion is subtracted and boxes grow by slack and half the margin. All arguments are on the device and
    /// borrowed until the next call.
    void move(View<const Vec3> x, const Trajectories& trajectories, double margin);

    /// Parts of move(). The refits are independent of each other, so edges may run on another stream. That
    /// stream must wait for place(), and anything else on the surface must wait for that stream.
    void place(View<const Vec3> x, const Trajectories& trajectories, double margin);
    void refit_triangles();
    void refit_edges(const CudaSpace& on);

    /// Records on the host what move() records, for a caller that launches a graph of it with these
    /// arguments.
    void note(const Trajectories& trajectories, double margin)
    {
        boxes_ = {points_.view(), trajectories.selected, largest_.view(), margin, passive_.view()};
    }

    /// Enqueues a refit for some vertices; `x` and `trajectories` may differ from those of move() only at
    /// these. Boxes above them grow and do not shrink.
    /// @param vertices      on the device, ascending
    /// @param trajectories  none empty; `selected` marks the vertices
    void move_some(View<const int> vertices, View<const Vec3> x, const Trajectories& trajectories);

    /// Enqueues a sort of vertices, edges and triangles along a curve through this pose. May allocate memory.
    void reorder(View<const Vec3> x);

    ImplicitBoxTree triangle_tree() const { return {triangle_shape_, triangle_nodes_.view()}; }
    ImplicitBoxTree edge_tree() const { return {edge_shape_, edge_nodes_.view()}; }
    const BoxesAtPoints& boxes() const { return boxes_; } ///< of the last move()
    ChangedPrimitives changed(View<const int> vertices, View<const unsigned char> is_changed) const
    {
        return {vertices, is_changed, triangles(), edges()};
    }

    int vertex_count() const { return points_.size(); }
    View<const Triangle> triangles() const { return triangles_.view(); }
    SurfaceEdgesView edges() const;
    /// Vertices that belong to triangles, and their order along the curve.
    View<const std::array<int, 1>> used_vertices() const { return used_vertices_.view(); }
    View<const int> vertex_order() const { return vertex_order_.view(); }
    View<const SoupExtent> extent() const { return extent_.view(); } ///< [1] of the last move()
    Bounds bounds() const;                                           ///< of the same on the host [m]; waits
    /// [1] [m^2] Half the surface of the triangles' tree, without the margin. It grows as motion degrades the
    /// order.
    View<const double> surface() const { return surface_.view(); }

private:
    template <typename Primitive>
    void order_along_curve(View<const Primitive> primitives, View<const Vec3> x, DeviceArray<int>& order);
    void find_slots(View<const int> order, DeviceArray<int>& slots);
    template <typename Primitive>
    void refit(const CudaSpace& on, const ImplicitShape& shape, View<const int> order,
               View<const Primitive> primitives, View<BoxNode> nodes);
    void measure(View<const Vec3> x, View<const Vec3> motion);

    const CudaSpace& space_;

    // Topology.
    DeviceArray<Triangle> triangles_;
    DeviceArray<std::array<int, 2>> edge_vertex_;
    DeviceArray<int> edge_triangles_first_, edge_triangles_;
    DeviceArray<std::array<int, 3>> triangle_edge_;
    DeviceArray<int> corners_first_, corners_;
    DeviceArray<std::array<int, 1>> used_vertices_; ///< that belong to triangles
    DeviceArray<unsigned char> passive_;            ///< [vertices], or empty

    // Trees.
    DeviceArray<int> vertex_order_, edge_order_, triangle_order_;
    DeviceArray<int> edge_slot_, triangle_slot_; ///< index in these orders
    ImplicitShape triangle_shape_, edge_shape_;
    DeviceArray<BoxNode> triangle_nodes_, edge_nodes_;
    SortArrays sort_;

    // State of the last move.
    DeviceArray<MovingPoint> points_;
    BoxesAtPoints boxes_;
    DeviceArray<SoupExtent> extent_, extent_sums_;
    DeviceArray<Largest> largest_, largest_sums_;
    DeviceArray<double> surface_, surface_sums_;
};

} // namespace toile::collision
