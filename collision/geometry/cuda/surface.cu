#include "collision/geometry/cuda/surface.h"

#include <vector>

#include "core/compute/cuda/upward_pass.cuh"

namespace toile::collision {

namespace {

static_assert(ImplicitShape::kFanBits == UpwardPass::kFanBits);

std::vector<std::array<int, 1>> list_used(const Incidence& corners_of_vertex, int vertex_count)
{
    std::vector<std::array<int, 1>> used;
    for (int v = 0; v < vertex_count; ++v)
        if (!corners_of_vertex.of(v).empty())
            used.push_back({v});
    return used;
}

} // namespace

DeviceSurface::DeviceSurface(const CudaSpace& space, View<const Triangle> triangles,
                             View<const Vec3> positions, View<const unsigned char> passive)
    : space_(space), triangles_(space, "surface/triangles"), edge_vertex_(space, "surface/edge_vertex"),
      edge_triangles_first_(space, "surface/edge_triangles_first"),
      edge_triangles_(space, "surface/edge_triangles"), triangle_edge_(space, "surface/triangle_edge"),
      corners_first_(space, "surface/corners_first"), corners_(space, "surface/corners"),
      used_vertices_(space, "surface/used_vertices"), passive_(space, "surface/passive"),
      vertex_order_(space, "surface/vertex_order"), edge_order_(space, "surface/edge_order"),
      triangle_order_(space, "surface/triangle_order"), edge_slot_(space, "surface/edge_slot"),
      triangle_slot_(space, "surface/triangle_slot"), triangle_shape_(triangles.size()), edge_shape_(0),
      triangle_nodes_(space, "surface/triangle_nodes"), edge_nodes_(space, "surface/edge_nodes"),
      sort_(space), points_(space, "surface/points", positions.size()), extent_(space, "surface/extent", 1),
      extent_sums_(space, "surface/extent_sums"), largest_(space, "surface/largest", 1),
      largest_sums_(space, "surface/largest_sums"), surface_(space, "surface/surface", 1),
      surface_sums_(space, "surface/surface_sums")
{
    const SurfaceEdges edges = build_surface_edges(triangles, positions.size());
    triangles_.upload(triangles);
    edge_vertex_.upload(edges.vertex);
    edge_triangles_first_.upload(edges.triangles.first);
    edge_triangles_.upload(edges.triangles.items);
    triangle_edge_.upload(edges.triangle_edge);
    corners_first_.upload(edges.corners_of_vertex.first);
    corners_.upload(edges.corners_of_vertex.items);
    used_vertices_.upload(list_used(edges.corners_of_vertex, positions.size()));
    passive_.upload(passive);

    // Upload empty boxes: nodes that pad a group of four are never written.
    edge_shape_ = ImplicitShape(edges.edge_count());
    triangle_nodes_.upload(std::vector<BoxNode>(triangle_shape_.node_count()));
    edge_nodes_.upload(std::vector<BoxNode>(edge_shape_.node_count()));

    DeviceArray<Vec3> x(space, "surface/first_pose");
    x.upload(positions);
    reorder(x.view());
}

SurfaceEdgesView DeviceSurface::edges() const
{
    return {edge_vertex_.view(),
            {edge_triangles_first_.view(), edge_triangles_.view()},
            triangle_edge_.view(),
            {corners_first_.view(), corners_.view()}};
}

void DeviceSurface::measure(View<const Vec3> x, View<const Vec3> motion)
{
    parallel_sum(space_, "collision/device_extent", x.size(), SoupExtent(), ExtentOfVertex{x, motion},
                 extent_.view(), extent_sums_);
}

void DeviceSurface::move(View<const Vec3> x, const Trajectories& trajectories, double margin)
{
    place(x, trajectories, margin);
    refit_triangles();
    refit_edges(space_);
}

void DeviceSurface::place(View<const Vec3> x, const Trajectories& trajectories, double margin)
{
    TOILE_ASSERT(x.size() == vertex_count());
    measure(x, trajectories.motion);
    parallel_sum(space_, "collision/device_points", x.size(), Largest(),
                 PlacePoint{x, trajectories, extent_.view(), points_.view()}, largest_.view(), largest_sums_);
    note(trajectories, margin);
}

void DeviceSurface::refit_edges(const CudaSpace& on)
{
    refit<std::array<int, 2>>(on, edge_shape_, edge_order_.view(), edge_vertex_.view(), edge_nodes_.view());
}

void DeviceSurface::refit_triangles()
{
    refit<Triangle>(space_, triangle_shape_, triangle_order_.view(), triangles_.view(),
                    triangle_nodes_.view());
    const int items = triangle_shape_.first[1];
    const View<const BoxNode> inner =
        triangle_tree().nodes.subview(items, triangle_shape_.node_count() - items);
    parallel_sum(space_, "collision/device_surface", inner.size(), 0.0, SurfaceOfNode{inner, boxes_},
                 surface_.view(), surface_sums_);
}

Bounds DeviceSurface::bounds() const
{
    SoupExtent extent;
    extent_.download({&extent, 1});
    return {extent.lower, extent.upper};
}

void DeviceSurface::move_some(View<const int> vertices, View<const Vec3> x, const Trajectories& trajectories)
{
    parallel_sum(space_, "collision/device_changed_points", vertices.size(), Largest(),
                 PlaceChanged{vertices, x, trajectories, extent_.view(), largest_.view(), points_.view()},
                 largest_.view(), largest_sums_);
    const ChangedPrimitives primitives = changed(vertices, trajectories.selected);
    parallel_for(space_, "collision/device_refit_changed", primitives.thread_count(),
                 RefitChanged{primitives,
                              boxes_,
                              {triangle_shape_, triangle_slot_.view(), triangle_nodes_.view()},
                              {edge_shape_, edge_slot_.view(), edge_nodes_.view()}});
}

template <typename Primitive>
void DeviceSurface::refit(const CudaSpace& on, const ImplicitShape& shape, View<const int> order,
                          View<const Primitive> primitives, View<BoxNode> nodes)
{
    const int fours = shape.size_of(1);
    parallel_for(on, "collision/device_refit", fours,
                 RefitItems<Primitive>{shape, order, primitives, boxes_, nodes}, 64);
    parallel_upward_pass(on, "collision/device_upward_pass", fours, RefitNodes{shape, nodes});
}

void DeviceSurface::reorder(View<const Vec3> x)
{
    measure(x, {});
    order_along_curve<Triangle>(triangles_.view(), x, triangle_order_);
    order_along_curve<std::array<int, 2>>(edge_vertex_.view(), x, edge_order_);
    order_along_curve<std::array<int, 1>>(used_vertices_.view(), x, vertex_order_);
    find_slots(triangle_order_.view(), triangle_slot_);
    find_slots(edge_order_.view(), edge_slot_);
}

void DeviceSurface::find_slots(View<const int> order, DeviceArray<int>& slots)
{
    slots.resize(order.size());
    parallel_for(space_, "collision/device_slots", order.size(), FindSlots{order, slots.view()});
}

template <typename Primitive>
void DeviceSurface::order_along_curve(View<const Primitive> primitives, View<const Vec3> x,
                                      DeviceArray<int>& order)
{
    sort_.resize(primitives.size());
    order.resize(primitives.size());
    parallel_for(
        space_, "collision/device_curve", primitives.size(),
        IndexOnCurve<Primitive>{primitives, x, extent_.view(), sort_.keys.view(), sort_.values.view()});
    sort_by_key(space_, "collision/device_reorder", sort_, order.view());
}

} // namespace toile::collision
