#pragma once

#include <limits>

#include "collision/changed_primitives.h"
#include "collision/implicit_box_tree.h"
#include "collision/moving_point.h"
#include "collision/space_curve.h"
#include "collision/ways.h"

namespace toile {

/// What all positions and motions have in common. Sums of it are exact but for `motion`.
struct SoupExtent {
    Vec3 lower = Vec3::Constant(std::numeric_limits<double>::max()); ///< [m]
    Vec3 upper = -lower;                                             ///< [m]
    Vec3 motion = Vec3::Zero();                                      ///< [m] sum
    int moving = 0; ///< 1: some vertex moves otherwise than the first

    TOILE_HD SoupExtent& operator+=(const SoupExtent& other)
    {
        lower = lower.cwiseMin(other.lower);
        upper = upper.cwiseMax(other.upper);
        motion += other.motion;
        moving |= other.moving;
        return *this;
    }

    /// @param count  vertices that were summed
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
    View<const Vec3> x, motion; ///< [vertices]; no motion where nothing moves

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

/// A number whose sum is the largest.
struct Largest {
    double value = 0.0;

    TOILE_HD Largest& operator+=(const Largest& other)
    {
        value = std::max(value, other.value);
        return *this;
    }
};

/// Places the moving point of a vertex; the term of the largest coordinate.
struct PlacePoint {
    View<const Vec3> x; ///< [vertices]
    Ways ways;
    View<const SoupExtent> extent; ///< [1]
    View<MovingPoint> points;      ///< [vertices] out

    TOILE_HD Largest operator()(int v) const
    {
        const MovingFrame frame = extent[0].frame(x.size());
        points[v] = frame.point(x[v], frame.is_moving ? ways.motion[v] : frame.mean,
                                ways.slack.empty() ? 0.0 : ways.slack[v]);
        return {points[v].largest()};
    }
};

/// Places the moving point of a vertex anew that now goes elsewhere than all have been placed for; the term
/// of the largest coordinate, of those as well.
struct PlaceChanged {
    View<const int> vertices; ///< that have changed
    View<const Vec3> x;       ///< [vertices of the soup]
    Ways ways;
    View<const SoupExtent> extent; ///< [1]
    View<const Largest> largest;   ///< [1]
    View<MovingPoint> points;      ///< [vertices of the soup] in, out

    TOILE_HD Largest operator()(int k) const
    {
        const int v = vertices[k];
        MovingFrame frame = extent[0].frame(x.size());
        frame.is_moving = true;
        points[v] = frame.point(x[v], ways.motion[v], ways.slack[v]);
        Largest most = largest[0];
        most += {points[v].largest()};
        return most;
    }
};

/// Boxes of primitives at their moving points, as a search has them.
struct BoxesAtPoints {
    View<const MovingPoint> points;
    View<const unsigned char> around; ///< Ways::around
    View<const Largest> largest;      ///< [1]
    double margin = 0.0;              ///< [m] of the search

    TOILE_HD float grown_by() const { return box_margin(margin, largest[0].value); }

    template <typename... Vertex>
    TOILE_HD BoxNode node(int number, Vertex... v) const
    {
        const bool is_wanted = around.empty() || ((around[v] != 0) || ...);
        return BoxNode::of_item(box_around(grown_by(), MovingPoint(points[v])...), number, is_wanted);
    }
    TOILE_HD BoxNode node(int number, const std::array<int, 2>& v) const { return node(number, v[0], v[1]); }
    TOILE_HD BoxNode node(int number, const Triangle& v) const { return node(number, v[0], v[1], v[2]); }
};

/// Boxes of four items of a tree and the box around them.
template <typename Primitive>
struct RefitItems {
    ImplicitShape shape;
    View<const int> order;            ///< [items] primitives in the tree's order
    View<const Primitive> primitives; ///< their vertices
    BoxesAtPoints boxes;
    View<BoxNode> nodes; ///< out: levels 0 and 1

    TOILE_HD void operator()(int c) const
    {
        BoxNode around;
        for (int k = 0; k < ImplicitShape::kFan; ++k) {
            const int item = ImplicitShape::kFan * c + k;
            if (item >= shape.count)
                break;
            const BoxNode node = boxes.node(order[item], primitives[order[item]]);
            nodes[item] = node;
            around.add(node);
        }
        nodes[shape.first[1] + c] = around;
    }
};

/// Boxes around boxes: climbs from level 1 of a tree, which counts as 0.
struct RefitNodes {
    ImplicitShape shape;
    View<BoxNode> nodes; ///< out: levels above 1

    TOILE_HD void operator()(int above_first, int c) const
    {
        const int level = above_first + 1, child = shape.first[level - 1] + ImplicitShape::kFan * c;
        BoxNode around = nodes[child];
        for (int k = 1; k < ImplicitShape::kFan; ++k)
            around.add(nodes[child + k]);
        nodes[shape.first[level] + c] = around;
    }
};

/// Where items of a tree are in its order.
struct FindPlaces {
    View<const int> order; ///< [items]
    View<int> places;      ///< [items] out

    TOILE_HD void operator()(int i) const { places[order[i]] = i; }
};

/// A tree of which some boxes change.
struct ChangingTree {
    ImplicitShape shape;
    View<const int> places; ///< [items] FindPlaces
    View<BoxNode> nodes;

    /// Puts an item, which one thread does, into its box, and grows those above until one has room for it: it
    /// has grown for others then, who go on.
    TOILE_HD void put(const BoxNode& item) const
    {
        int node = places[item.last];
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

/// Puts triangles and edges of changed vertices into their trees anew.
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

/// Half the surface of a node, less the margin: the term of a tree's wear.
struct SurfaceOfNode {
    View<const BoxNode> nodes;
    BoxesAtPoints boxes;

    TOILE_HD double operator()(int i) const { return double(nodes[i].box().half_area(boxes.grown_by())); }
};

/// Where primitives lie on the curve through all vertices.
template <typename Primitive>
struct PlaceOnCurve {
    View<const Primitive> primitives; ///< vertices of each
    View<const Vec3> x;               ///< [m]
    View<const SoupExtent> extent;    ///< [1]
    View<std::uint64_t> keys;         ///< out
    View<int> numbers;                ///< out: of the primitives

    TOILE_HD void operator()(int i) const
    {
        const int corners = int(primitives[i].size());
        Vec3 sum = Vec3::Zero();
        for (int k = 0; k < corners; ++k)
            sum += x[primitives[i][k]];
        keys[i] = SpaceCurve::through(extent[0].lower, extent[0].upper).place(sum / corners);
        numbers[i] = i;
    }
};

} // namespace toile
