#pragma once

#include <limits>

#include "collision/bvh/implicit_box_tree.h"
#include "collision/geometry/changed_primitives.h"
#include "collision/geometry/moving_point.h"
#include "collision/geometry/space_curve.h"
#include "collision/geometry/trajectories.h"

namespace toile::collision {

/// Bounds and mean motion of all vertices, as a sum. All members but `motion` are exact.
struct SoupExtent {
    Vec3 lower = Vec3::Constant(std::numeric_limits<double>::max()); ///< [m]
    Vec3 upper = -lower;                                             ///< [m]
    Vec3 motion = Vec3::Zero();                                      ///< [m] sum
    int moving = 0; ///< 1: some vertex moves differently from the first

    TOILE_HD SoupExtent& operator+=(const SoupExtent& other)
    {
        lower = lower.cwiseMin(other.lower);
        upper = upper.cwiseMax(other.upper);
        motion += other.motion;
        moving |= other.moving;
        return *this;
    }

    /// @param count  number of vertices summed
    TOILE_HD MovingFrame frame(int count) const
    {
        MovingFrame frame;
        frame.center = 0.5 * (lower + upper);
        frame.is_moving = moving != 0;
        frame.mean = motion / count;
        return frame;
    }
};

struct ExtentOfVertex {
    View<const Vec3> x, motion; ///< [vertices]; motion is empty if nothing moves

    TOILE_HD SoupExtent operator()(int v) const
    {
        SoupExtent extent;
        extent.lower = extent.upper = x[v];
        if (!motion.empty()) {
            extent.motion = motion[v];
            extent.moving = int(motion[v] != motion[0]);
        }
        return extent;
    }
};

/// Number whose sum is the maximum.
struct Largest {
    double value = 0.0;

    TOILE_HD Largest& operator+=(const Largest& other)
    {
        value = std::max(value, other.value);
        return *this;
    }
};

/// Writes the moving point of a vertex; returns its largest coordinate.
struct PlacePoint {
    View<const Vec3> x; ///< [vertices]
    Trajectories trajectories;
    View<const SoupExtent> extent; ///< [1]
    View<MovingPoint> points;      ///< [vertices] out

    TOILE_HD Largest operator()(int v) const
    {
        const MovingFrame frame = extent[0].frame(x.size());
        points[v] = frame.point(x[v], frame.is_moving ? trajectories.motion[v] : frame.mean,
                                trajectories.slack.empty() ? 0.0 : trajectories.slack[v]);
        return {points[v].largest()};
    }
};

/// Rewrites the moving point of a vertex whose trajectory has changed. Returns the largest coordinate,
/// including the earlier maximum.
struct PlaceChanged {
    View<const int> vertices; ///< changed vertices
    View<const Vec3> x;       ///< [vertices of the soup]
    Trajectories trajectories;
    View<const SoupExtent> extent; ///< [1]
    View<const Largest> largest;   ///< [1]
    View<MovingPoint> points;      ///< [vertices of the soup] in, out

    TOILE_HD Largest operator()(int k) const
    {
        const int v = vertices[k];
        MovingFrame frame = extent[0].frame(x.size());
        frame.is_moving = true;
        points[v] = frame.point(x[v], trajectories.motion[v], trajectories.slack[v]);
        Largest max_coordinate = largest[0];
        max_coordinate += {points[v].largest()};
        return max_coordinate;
    }
};

/// Boxes of primitives at their moving points, as a search needs them.
struct BoxesAtPoints {
    View<const MovingPoint> points;
    View<const unsigned char> selected;     ///< see Trajectories
    View<const Largest> largest;            ///< [1]
    double margin = 0.0;                    ///< [m] margin of the search
    View<const unsigned char> passive = {}; ///< see DeviceSurface

    TOILE_HD float grown_by() const { return box_margin(margin, largest[0].value); }

    template <typename... Vertex>
    TOILE_HD BoxNode node(int number, int first, Vertex... others) const
    {
        const bool is_selected = selected.empty() || selected[first] != 0 || ((selected[others] != 0) || ...);
        const bool is_wanted = is_selected && (passive.empty() || passive[first] == 0);
        return BoxNode::of_item(
            collision::box_around(grown_by(), MovingPoint(points[first]), MovingPoint(points[others])...),
            number, is_wanted);
    }
    TOILE_HD BoxNode node(int number, const std::array<int, 2>& v) const { return node(number, v[0], v[1]); }
    TOILE_HD BoxNode node(int number, const Triangle& v) const { return node(number, v[0], v[1], v[2]); }
};

/// Computes the boxes of four items of a tree and the box around them.
template <typename Primitive>
struct RefitItems {
    ImplicitShape shape;
    View<const int> order;            ///< [items] primitives in the tree's order
    View<const Primitive> primitives; ///< their vertices
    BoxesAtPoints boxes;
    View<BoxNode> nodes; ///< out: levels 0 and 1

    TOILE_HD void operator()(int c) const
    {
        BoxNode bounds;
        for (int k = 0; k < ImplicitShape::kFan; ++k) {
            const int item = ImplicitShape::kFan * c + k;
            if (item >= shape.count)
                break;
            const BoxNode node = boxes.node(order[item], primitives[order[item]]);
            nodes[item] = node;
            bounds.add(node);
        }
        nodes[shape.first[1] + c] = bounds;
    }
};

/// Computes the boxes of inner nodes in an upward pass from level 1, which counts as 0.
struct RefitNodes {
    ImplicitShape shape;
    View<BoxNode> nodes; ///< out: levels above 1

    TOILE_HD void operator()(int above_first, int c) const
    {
        const int level = above_first + 1, child = shape.first[level - 1] + ImplicitShape::kFan * c;
        BoxNode bounds = nodes[child];
        for (int k = 1; k < ImplicitShape::kFan; ++k)
            bounds.add(nodes[child + k]);
        nodes[shape.first[level] + c] = bounds;
    }
};

/// Inverts the tree's order: index of each item.
struct FindSlots {
    View<const int> order; ///< [items]
    View<int> slots;       ///< [items] out

    TOILE_HD void operator()(int i) const { slots[order[i]] = i; }
};

/// Tree with some changed boxes.
struct ChangingTree {
    ImplicitShape shape;
    View<const int> slots; ///< [items] see FindSlots
    View<BoxNode> nodes;

    /// Writes an item's box, by one thread, and extends its ancestors up to the first that contains it. Such
    /// an ancestor was extended by other threads, which continue upwards.
    TOILE_HD void put(const BoxNode& item) const
    {
        int node = slots[item.last];
        nodes[node] = item;
        for (int level = 1; level <= shape.top; ++level) {
            node >>= ImplicitShape::kFanBits;
            BoxNode& above = nodes[shape.first[level] + node];
            if (above.contains(item))
                return;
            above.grow_shared(item);
        }
    }
};

/// Updates the boxes of triangles and edges of changed vertices in their trees.
struct RefitChanged {
    ChangedPrimitives changed;
    BoxesAtPoints boxes;
    ChangingTree triangle_tree, edge_tree;

    TOILE_HD void operator()(int thread) const
    {
        changed.visit(
            thread, [](int) {}, [&](int t) { triangle_tree.put(boxes.node(t, changed.triangles[t])); },
            [&](int e) { edge_tree.put(boxes.node(e, changed.edges.vertex[e])); });
    }
};

/// Half the surface of a node, without the margin: the summand of the tree's degradation.
struct SurfaceOfNode {
    View<const BoxNode> nodes;
    BoxesAtPoints boxes;

    TOILE_HD double operator()(int i) const { return double(nodes[i].box().half_area(boxes.grown_by())); }
};

/// Index of primitives along the curve through all vertices.
template <typename Primitive>
struct IndexOnCurve {
    View<const Primitive> primitives; ///< vertices of each primitive
    View<const Vec3> x;               ///< [m]
    View<const SoupExtent> extent;    ///< [1]
    View<std::uint64_t> keys;         ///< out
    View<int> numbers;                ///< out: number of the primitive

    TOILE_HD void operator()(int i) const
    {
        const int corners = int(primitives[i].size());
        Vec3 sum = Vec3::Zero();
        for (int k = 0; k < corners; ++k)
            sum += x[primitives[i][k]];
        keys[i] = SpaceCurve::through(extent[0].lower, extent[0].upper).index(sum / corners);
        numbers[i] = i;
    }
};

} // namespace toile::collision
