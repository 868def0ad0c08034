#pragma once

/// Surface of DeviceSurface: its kernels, run on the CPU.

#include <algorithm>
#include <vector>

#include "collision/geometry/cuda/surface_kernels.h"
#include "collision/geometry/surface_edges.h"
#include "core/compute/parallel.h"

namespace toile::test {

using namespace collision;

class SurfaceOnCpu {
public:
    SurfaceOnCpu(const std::vector<Triangle>& of, const std::vector<Vec3>& at,
                 const Trajectories& trajectories, double margin)
        : triangles(of), x(at), edges(build_surface_edges(triangles, int(x.size())))
    {
        const int count = int(x.size());
        extent[0] = parallel_sum(kCpu, count, SoupExtent(), ExtentOfVertex{x, trajectories.motion});
        points_.resize(count);
        largest_[0] = parallel_sum(kCpu, count, Largest(), PlacePoint{x, trajectories, extent, points_});
        boxes = {points_, trajectories.selected, largest_, margin};
        for (int v = 0; v < count; ++v)
            if (!edges.corners_of_vertex.of(v).empty())
                used.push_back({v});
        build<Triangle>(triangles, triangle_shape_, triangle_slot_, triangle_nodes_);
        build<std::array<int, 2>>(edges.vertex, edge_shape_, edge_slot_, edge_nodes_);
        vertex_order = order_of<std::array<int, 1>>(used);
    }

    /// Moves some vertices as DeviceSurface does.
    void move_some(const std::vector<int>& vertices, const Trajectories& trajectories)
    {
        largest_[0] = parallel_sum(kCpu, int(vertices.size()), Largest(),
                                   PlaceChanged{vertices, x, trajectories, extent, largest_, points_});
        const ChangedPrimitives primitives = changed(vertices, trajectories.selected);
        parallel_for(kCpu, "test/refit_changed", primitives.thread_count(),
                     RefitChanged{primitives,
                                  boxes,
                                  {triangle_shape_, triangle_slot_, triangle_nodes_},
                                  {edge_shape_, edge_slot_, edge_nodes_}});
    }
    ChangedPrimitives changed(const std::vector<int>& vertices, View<const unsigned char> is_changed) const
    {
        return {vertices, is_changed, triangles, view_of(edges)};
    }

    int vertex_count() const { return int(x.size()); }
    ImplicitBoxTree triangle_tree() const { return {triangle_shape_, triangle_nodes_}; }
    ImplicitBoxTree edge_tree() const { return {edge_shape_, edge_nodes_}; }
    View<const BoxNode> triangle_items() const
    {
        return View<const BoxNode>(triangle_nodes_).subview(0, triangle_shape_.count);
    }
    View<const BoxNode> edge_items() const
    {
        return View<const BoxNode>(edge_nodes_).subview(0, edge_shape_.count);
    }

    const std::vector<Triangle>& triangles;
    const std::vector<Vec3>& x;
    SurfaceEdges edges;
    std::vector<std::array<int, 1>> used;
    std::vector<int> vertex_order;
    std::vector<SoupExtent> extent{1};
    BoxesAtPoints boxes;

private:
    template <typename Primitive>
    std::vector<int> order_of(View<const Primitive> primitives)
    {
        std::vector<std::uint64_t> keys(primitives.size());
        std::vector<int> order(primitives.size());
        parallel_for(kCpu, "test/curve", primitives.size(),
                     IndexOnCurve<Primitive>{primitives, x, extent, keys, order});
        std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return keys[a] < keys[b]; });
        return order;
    }

    template <typename Primitive>
    void build(View<const Primitive> primitives, ImplicitShape& shape, std::vector<int>& slots,
               std::vector<BoxNode>& nodes)
    {
        shape = ImplicitShape(primitives.size());
        nodes.assign(shape.node_count(), BoxNode());
        const std::vector<int> order = order_of<Primitive>(primitives);
        slots.resize(order.size());
        parallel_for(kCpu, "test/places", int(order.size()), FindSlots{order, slots});
        parallel_for(kCpu, "test/refit", shape.size_of(1),
                     RefitItems<Primitive>{shape, order, primitives, boxes, nodes});
        for (int level = 2; level <= shape.top; ++level)
            for (int c = 0; c < shape.size_of(level); ++c)
                RefitNodes{shape, nodes}(level - 1, c);
    }

    std::vector<Largest> largest_{1};
    std::vector<MovingPoint> points_;
    ImplicitShape triangle_shape_{0}, edge_shape_{0};
    std::vector<int> triangle_slot_, edge_slot_;
    std::vector<BoxNode> triangle_nodes_, edge_nodes_;
};

} // namespace toile::test
