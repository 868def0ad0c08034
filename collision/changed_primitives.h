#pragma once

#include "collision/surface_edges.h"

namespace toile {

/// Vertices of a soup that have changed, with the triangles and edges that have one of them, each once: those
/// belong to the lowest of their changed vertices. Shared out among threads, or teams of threads, for a GPU:
/// one for each vertex, then kTriangleThreads of each for its triangles, then kEdgeThreads for its edges, so
/// that neighbours do the same.
struct ChangedPrimitives {
    static constexpr int kTriangleThreads = 8, kEdgeThreads = 16;
    static constexpr int kThreads = 1 + kTriangleThreads + kEdgeThreads; ///< of each vertex

    View<const int> vertices;             ///< that have changed
    View<const unsigned char> is_changed; ///< [all vertices] 1: one of them
    View<const Triangle> triangles;
    SurfaceEdgesView edges;

    TOILE_HD int thread_count() const { return kThreads * vertices.size(); }

    /// Calls on_vertex(number), on_triangle(number) or on_edge(number) for what is the thread's. Vertices of
    /// no triangle are left out.
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
    /// Of a triangle or an edge with v [-].
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
            const bool is_met_before = i > 0 && corners[i - 1] / 3 == t; // collapsed
            if (!is_met_before && is_lowest_changed(v, triangles[t]))
                on_triangle(t);
        }
    }

    /// At every corner of v: the edge that leaves it and the one that comes to it.
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
            const bool is_met_leaving = !leaves && triangles[t][side] == v; // from v to v
            if (!is_met_leaving && edges.is_met_first(e, t, side) && is_lowest_changed(v, edges.vertex[e]))
                on_edge(e);
        }
    }
};

} // namespace toile
