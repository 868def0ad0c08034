#pragma once

#include "collision/geometry/surface_edges.h"

namespace toile::collision {

/// Changed vertices of a soup with their triangles and edges, each visited once. A triangle or edge belongs
/// to its lowest changed vertex.
///
/// Work is distributed over threads, or teams of threads, of a GPU: one per vertex, then kTriangleThreads per
/// vertex for its triangles, then kEdgeThreads for its edges. Neighbouring threads thus do the same kind of
/// work.
struct ChangedPrimitives {
    static constexpr int kTriangleThreads = 8, kEdgeThreads = 16;
    static constexpr int kThreads = 1 + kTriangleThreads + kEdgeThreads; ///< per changed vertex

    View<const int> vertices;             ///< changed vertices
    View<const unsigned char> is_changed; ///< [all vertices] 1: changed
    View<const Triangle> triangles;
    SurfaceEdgesView edges;

    TOILE_HD int thread_count() const { return kThreads * vertices.size(); }

    /// Calls on_vertex(number), on_triangle(number) or on_edge(number) for the thread's items. Skips vertices
    /// without a triangle.
    template <typename OnVertex, typename OnTriangle, typename OnEdge>
    TOILE_HD void visit(int thread, const OnVertex& on_vertex, const OnTriangle& on_triangle,
                        const OnEdge& on_edge) const
    {
        const int first_of_triangles = vertices.size();
        const int first_of_edges = (1 + kTriangleThreads) * vertices.size();
        if (thread < first_of_triangles)
            visit_vertex(vertices[thread], on_vertex);
        else if (thread < first_of_edges)
            visit_triangles(thread - first_of_triangles, on_triangle);
        else
            visit_edges(thread - first_of_edges, on_edge);
    }

    TOILE_HD bool has_changed(const std::array<int, 2>& edge) const
    {
        return is_changed[edge[0]] != 0 || is_changed[edge[1]] != 0;
    }

private:
    /// True if v is the lowest changed vertex of its triangle or edge.
    template <typename Primitive>
    TOILE_HD bool is_lowest_changed(int v, const Primitive& primitive) const
    {
        for (int k = 0; k < int(primitive.size()); ++k)
            if (primitive[k] < v && is_changed[primitive[k]] != 0)
                return false;
        return true;
    }

    template <typename OnVertex>
    TOILE_HD void visit_vertex(int v, const OnVertex& on_vertex) const
    {
        if (!edges.corners_of_vertex.of(v).empty())
            on_vertex(v);
    }

    template <typename OnTriangle>
    TOILE_HD void visit_triangles(int thread, const OnTriangle& on_triangle) const
    {
        const int v = vertices[thread / kTriangleThreads];
        const View<const int> corners = edges.corners_of_vertex.of(v);
        for (int i = thread % kTriangleThreads; i < corners.size(); i += kTriangleThreads) {
            const int t = corners[i] / 3;
            const bool is_met_before = i > 0 && corners[i - 1] / 3 == t; // collapsed triangle: listed twice
            if (!is_met_before && is_lowest_changed(v, triangles[t]))
                on_triangle(t);
        }
    }

    /// Visits two edges at every corner of v: the one that leaves v and the one that arrives.
    template <typename OnEdge>
    TOILE_HD void visit_edges(int thread, const OnEdge& on_edge) const
    {
        const int v = vertices[thread / kEdgeThreads];
        const View<const int> corners = edges.corners_of_vertex.of(v);
        for (int i = thread % kEdgeThreads; i < 2 * corners.size(); i += kEdgeThreads) {
            const int t = corners[i / 2] / 3, corner = corners[i / 2] % 3;
            const bool leaves = i % 2 == 0;
            const int side = leaves ? corner : (corner + 2) % 3;
            const int e = edges.triangle_edge[t][side];
            const bool is_met_leaving = !leaves && triangles[t][side] == v; // edge from v to v
            if (!is_met_leaving && edges.is_met_first(e, t, side) && is_lowest_changed(v, edges.vertex[e]))
                on_edge(e);
        }
    }
};

} // namespace toile::collision
