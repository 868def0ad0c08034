#include "collision/repair/joined_cloths.h"

namespace toile::collision {

namespace {

/// Numbers the pieces connected by triangles in the order of their first vertices.
std::vector<int> pieces_of(View<const Triangle> triangles, const SurfaceEdges& edges, int vertex_count)
{
    std::vector<int> piece(vertex_count, -1);
    std::vector<int> open;
    int count = 0;
    for (int first = 0; first < vertex_count; ++first) {
        if (piece[first] >= 0 || edges.corners_of_vertex.of(first).empty())
            continue;
        piece[first] = count;
        open.push_back(first);
        while (!open.empty()) {
            const int v = open.back();
            open.pop_back();
            for (const int corner : edges.corners_of_vertex.of(v))
                for (const int w : triangles[corner / 3])
                    if (piece[w] < 0) {
                        piece[w] = count;
                        open.push_back(w);
                    }
        }
        ++count;
    }
    return piece;
}

int third_corner(const Triangle& corner, const std::array<int, 2>& edge)
{
    for (const int v : corner)
        if (v != edge[0] && v != edge[1])
            return v;
    return -1;
}

} // namespace

JoinedCloths::JoinedCloths(const std::vector<StartCloth>& cloths) : first_vertex{0}
{
    for (size_t c = 0; c < cloths.size(); ++c) {
        const StartCloth& one = cloths[c];
        const size_t count = one.positions.size();
        for (const Triangle& t : one.triangles)
            triangles.push_back(t + Triangle::Constant(first_vertex.back()));
        start.insert(start.end(), one.positions.begin(), one.positions.end());
        fixed.insert(fixed.end(), one.fixed.begin(), one.fixed.end());
        fixed.resize(start.size(), 0);
        gap.insert(gap.end(), count, one.gap);
        thickness.insert(thickness.end(), count, one.thickness);
        cloth.insert(cloth.end(), count, int(c));
        first_vertex.push_back(int(start.size()));
    }

    edges = build_surface_edges(triangles, vertex_count());
    piece = pieces_of(triangles, edges, vertex_count());
    for (int v = 0; v < vertex_count(); ++v)
        if (piece[v] == int(layer.size()))
            layer.push_back(cloths[cloth[v]].layer);

    for (int e = 0; e < edges.edge_count(); ++e) {
        const View<const int> sides = edges.triangles.of(e);
        const bool is_inner = sides.size() == 2;
        opposite.push_back(is_inner ? std::array<int, 2>{third_corner(triangles[sides[0]], edges.vertex[e]),
                                                         third_corner(triangles[sides[1]], edges.vertex[e])}
                                    : std::array<int, 2>{-1, -1});
        length.push_back((start[edges.vertex[e][0]] - start[edges.vertex[e][1]]).norm());
        mean_length += length.back();
    }
    mean_length /= double(std::max(edges.edge_count(), 1));
    given_layer = layer;
}

} // namespace toile::collision
