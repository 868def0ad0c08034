#pragma once

#include "collision/bvh/box_tree.h"
#include "collision/geometry/moving_point.h"
#include "collision/geometry/surface_edges.h"
#include "collision/self/near_pairs.h"
#include "collision/self/primitive_boxes.h"

namespace toile::collision {

/// Broad phase of NearPairs: pairs of vertices and triangles, and of edges, whose boxes overlap. A box
/// contains the straight trajectories of its vertices less the mean motion, enlarged by their slack and half
/// the margin.
class Candidates {
public:
    /// Builds the tree. triangles, edges and rigid must outlive this.
    /// @param rigid  see NearPairs
    Candidates(View<const Triangle> triangles, const SurfaceEdges& edges, View<const Vec3> positions,
               View<const int> rigid);

    /// Sets positions and trajectories of the vertices. See NearPairs::find.
    void place(View<const Vec3> x, const Trajectories& trajectories, double margin);

    /// Whether selected vertices that are prescribed count as selected.
    enum class Prescribed { kPassive, kSelectable };

    /// Updates the boxes for visit(), and rebuilds a worn-out tree.
    /// @param selected  [vertices] see Trajectories
    void update(View<const unsigned char> selected, Prescribed prescribed);

    /// True if some vertex moves differently from the others.
    bool is_moving() const { return is_moving_; }

    /// Number of parts of the search that may run in parallel; independent of the number of threads.
    int task_count() const { return int(tasks_.size()); }

    /// Whether the boxes of two primitives overlap.
    template <typename A, typename B>
    bool overlap(const A& a, const B& b) const
    {
        return box_of(a).overlaps(box_of(b));
    }

    /// Calls try_edges(e, f) and try_triangle(v, t) for the task's candidates, including primitives with
    /// common vertices. If update() was given `selected`, candidates without a selected vertex are skipped.
    /// Passive prescribed vertices are not selected, nor are candidates of them alone visited.
    /// Over all tasks each pair occurs at most once.
    template <typename TryEdges, typename TryTriangle>
    void visit(int task, const TryEdges& try_edges, const TryTriangle& try_triangle) const
    {
        tree_.descend(tasks_[task], [&](const BoxTree::Node& a, const BoxTree::Node& b) {
            meet_edges(a, b, try_edges);
            meet_vertices(a, b, try_triangle);
            if (a.leaf != b.leaf)
                meet_vertices(b, a, try_triangle);
        });
    }

private:
    Box box_of(const std::array<int, 1>& v) const
    {
        return collision::box_around(box_margin_, points_[v[0]]);
    }
    Box box_of(const std::array<int, 2>& v) const
    {
        return collision::box_around(box_margin_, points_[v[0]], points_[v[1]]);
    }
    Box box_of(const Triangle& v) const
    {
        return collision::box_around(box_margin_, points_[v[0]], points_[v[1]], points_[v[2]]);
    }
    template <typename Vertices>
    bool is_wanted(const Vertices& vertices) const
    {
        if (prescribed_ == Prescribed::kPassive && !rigid_.empty() && rigid_[vertices[0]] == kPrescribed)
            return false;
        return selected_.empty() ||
               std::any_of(vertices.begin(), vertices.end(), [&](int v) { return selected_[v] != 0; });
    }
    void fill_leaf(int leaf);
    void refit();
    void rebuild();

    template <typename TryEdges>
    void meet_edges(const BoxTree::Node& a, const BoxTree::Node& b, const TryEdges& try_edges) const;
    template <typename TryTriangle>
    void meet_vertices(const BoxTree::Node& a, const BoxTree::Node& b, const TryTriangle& try_triangle) const;

    View<const Triangle> triangles_;
    const SurfaceEdges& edges_;
    View<const int> rigid_;
    BoxTree tree_;
    PrimitiveBoxes boxes_;
    double built_surface_ = 0.0; ///< [m^2] surface of the tree when it was built

    std::vector<MovingPoint> points_; ///< [vertices] relative to the centre of their box
    bool is_moving_ = false;
    float box_margin_ = 0.0f; ///< [m] half the margin plus rounding of single precision
    View<const unsigned char> selected_;
    Prescribed prescribed_ = Prescribed::kPassive;
    std::vector<Box> leaf_boxes_;
    std::vector<unsigned char> leaf_is_wanted_;
    std::vector<BoxTree::NodePair> tasks_;
};

template <typename TryEdges>
void Candidates::meet_edges(const BoxTree::Node& a, const BoxTree::Node& b, const TryEdges& try_edges) const
{
    const PrimitiveBoxes::Kind& edges = boxes_.edges;
    const bool is_same = a.leaf == b.leaf;
    for (int i = edges.first_block[a.leaf]; i < edges.first_block[a.leaf + 1]; ++i)
        for_each_lane(edges.block[i].overlaps(b.box), [&](int lane) {
            const Box box = edges.block[i].get(lane);
            const bool is_wanted = edges.is_wanted(i, lane);
            const int e = edges.item_of(i, lane);
            for (int j = is_same ? i : edges.first_block[b.leaf]; j < edges.first_block[b.leaf + 1]; ++j)
                if (is_wanted || edges.wanted[j] != 0)
                    for_each_lane(edges.block[j].overlaps(box), [&](int other) {
                        if ((!is_same || j > i || other > lane) && (is_wanted || edges.is_wanted(j, other)))
                            try_edges(e, edges.item_of(j, other));
                    });
        });
}

template <typename TryTriangle>
void Candidates::meet_vertices(const BoxTree::Node& a, const BoxTree::Node& b,
                               const TryTriangle& try_triangle) const
{
    const PrimitiveBoxes::Kind &vertices = boxes_.vertices, &triangles = boxes_.triangles;
    for (int i = vertices.first_block[a.leaf]; i < vertices.first_block[a.leaf + 1]; ++i)
        for_each_lane(vertices.block[i].overlaps(b.box), [&](int lane) {
            const Box box = vertices.block[i].get(lane);
            const bool is_wanted = vertices.is_wanted(i, lane);
            const int v = vertices.item_of(i, lane);
            for (int j = triangles.first_block[b.leaf]; j < triangles.first_block[b.leaf + 1]; ++j)
                if (is_wanted || triangles.wanted[j] != 0)
                    for_each_lane(triangles.block[j].overlaps(box), [&](int other) {
                        if (is_wanted || triangles.is_wanted(j, other))
                            try_triangle(v, triangles.item_of(j, other));
                    });
        });
}

} // namespace toile::collision
