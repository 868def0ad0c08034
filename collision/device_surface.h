#pragma once

#include "collision/device_surface_kernels.h"
#include "collision/surface_edges.h"
#include "core/backend/cuda/array.h"
#include "core/backend/cuda/sort.h"
#include "core/mesh/triangle_mesh.h"

namespace toile {

/// A triangle soup on a GPU whose vertices move: who shares what, and trees of boxes over its triangles and
/// over its edges. The trees have no pointers; their items lie in the order of a Hilbert curve through a
/// pose, which is chosen rarely, and only the boxes are renewed from search to search.
class DeviceSurface {
public:
    /// @param triangles  [triangles x 3] indices into positions; any list: collapsed, non-manifold
    /// @param positions  [vertices x 3] [m] the first pose, of the host
    DeviceSurface(const CudaSpace& space, View<const Triangle> triangles, View<const Vec3> positions);

    /// Enqueues: new boxes around the straight ways of all vertices, less the mean motion, grown by slack and
    /// half the margin, as Candidates::update has them. All arguments on the device, borrowed until the next.
    void move(View<const Vec3> x, const Ways& ways, double margin);

    /// move() in parts, of which the last two need nothing of each other: edges may go to another stream,
    /// which must have waited for place() and be waited for before anything else of the surface.
    void place(View<const Vec3> x, const Ways& ways, double margin);
    void refit_triangles();
    void refit_edges(const CudaSpace& on);

    /// What move() notes on the host, for who launches a recording of it with these arguments.
    void note(const Ways& ways, double margin)
    {
        boxes_ = {points_.view(), ways.around, largest_.view(), margin};
    }

    /// Enqueues: the same of some vertices, the others as move() has placed them: `ways` and `x` differ from
    /// those of move() at most there. Boxes above them grow and do not shrink.
    /// @param vertices  on the device, ascending
    /// @param ways      none empty; `around` marks the vertices
    void move_some(View<const int> vertices, View<const Vec3> x, const Ways& ways);

    /// Enqueues: orders vertices, edges and triangles along a curve through this pose. May ask for memory.
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
    /// Vertices of triangles, and their order along the curve.
    View<const std::array<int, 1>> used_vertices() const { return used_vertices_.view(); }
    View<const int> vertex_order() const { return vertex_order_.view(); }
    View<const SoupExtent> extent() const { return extent_.view(); } ///< [1] of the last move()
    Bounds bounds() const;                                           ///< around it, on the host [m]. Waits
    /// [1] [m^2] half the surface of the triangles' tree, less the margin: grows as its order goes bad.
    View<const double> surface() const { return surface_.view(); }

private:
    template <typename Primitive>
    void order_along_curve(View<const Primitive> primitives, View<const Vec3> x, DeviceArray<int>& order);
    void find_places(View<const int> order, DeviceArray<int>& places);
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
    DeviceArray<std::array<int, 1>> used_vertices_; ///< those of triangles

    // Trees.
    DeviceArray<int> vertex_order_, edge_order_, triangle_order_;
    DeviceArray<int> edge_place_, triangle_place_; ///< in these
    ImplicitShape triangle_shape_, edge_shape_;
    DeviceArray<BoxNode> triangle_nodes_, edge_nodes_;
    SortArrays sort_;

    // Of the last move.
    DeviceArray<MovingPoint> points_;
    BoxesAtPoints boxes_;
    DeviceArray<SoupExtent> extent_, extent_sums_;
    DeviceArray<Largest> largest_, largest_sums_;
    DeviceArray<double> surface_, surface_sums_;
};

} // namespace toile
