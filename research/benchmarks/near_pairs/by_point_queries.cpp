#include "research/benchmarks/near_pairs/by_point_queries.h"

#include "core/compute/parallel.h"

namespace toile::research::near_pairs {

ByPointQueries::ByPointQueries(View<const Triangle> triangles, View<const Vec3> positions)
    : surface_(triangles, positions)
{
}

void ByPointQueries::find_triangles(int v, double margin, std::vector<Found>& out) const
{
    thread_local std::vector<int> near;
    const View<const Vec3> x = surface_.positions();
    surface_.triangles_maybe_near(x[v], x[v], margin, near);
    for (const int t : near) {
        const Triangle& c = surface_.triangles()[t];
        if (c[0] == v || c[1] == v || c[2] == v)
            continue;
        if (collision::closest_on_triangle(x[v], x[c[0]], x[c[1]], x[c[2]]).distance2 <= margin * margin)
            out.push_back({v, t});
    }
}

void ByPointQueries::find_edges(int e, double margin, std::vector<Found>& out) const
{
    thread_local std::vector<int> near;
    const collision::SurfaceEdges& edges = surface_.edges();
    const View<const Vec3> x = surface_.positions();
    const auto& a = edges.vertex[e];
    surface_.triangles_maybe_near(x[a[0]], x[a[1]], margin, near);
    for (const int t : near)
        for (const int f : edges.triangle_edge[t]) {
            const auto& b = edges.vertex[f];
            const bool is_owned = edges.triangles.of(f)[0] == t;
            if (f <= e || !is_owned || a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1])
                continue;
            if (collision::closest_on_segments(x[a[0]], x[a[1]], x[b[0]], x[b[1]]).distance2 <=
                margin * margin)
                out.push_back({e, f});
        }
}

size_t ByPointQueries::find(View<const Vec3> x, double margin)
{
    surface_.update(x);
    found_.clear();
    parallel_append(
        kCpu, "near_pairs/vertices", x.size(),
        [&](int begin, int end, std::vector<Found>& out) {
            for (int v = begin; v < end; ++v)
                find_triangles(v, margin, out);
        },
        found_);
    parallel_append(
        kCpu, "near_pairs/edges", surface_.edges().edge_count(),
        [&](int begin, int end, std::vector<Found>& out) {
            for (int e = begin; e < end; ++e)
                find_edges(e, margin, out);
        },
        found_);
    return found_.size();
}

} // namespace toile::research::near_pairs
