#include "scenes/colliders/select_vertices.h"

#include <algorithm>

namespace toile::scenes {

namespace {

int nearest_vertex(View<const Vec3> x, const Vec3& point)
{
    int best = 0;
    for (int v = 1; v < x.size(); ++v)
        if ((x[v] - point).squaredNorm() < (x[best] - point).squaredNorm())
            best = v;
    return best;
}

} // namespace

std::vector<int> select_vertices(const scene::Selection& select, View<const Vec3> start,
                                 const std::vector<Collider>& colliders)
{
    std::vector<int> vertices;
    const auto add_if = [&](const auto& is_selected) {
        for (int v = 0; v < start.size(); ++v)
            if (is_selected(start[v]))
                vertices.push_back(v);
    };
    if (const auto* indices = std::get_if<std::vector<int>>(&select.by)) {
        vertices = *indices;
    } else if (const auto* points = std::get_if<std::vector<Vec3>>(&select.by)) {
        for (const Vec3& point : *points)
            vertices.push_back(nearest_vertex(start, point));
    } else if (const auto* box = std::get_if<scene::SelectBox>(&select.by)) {
        add_if([&](const Vec3& x) {
            return (x.array() >= box->lower.array()).all() && (x.array() <= box->upper.array()).all();
        });
    } else {
        const auto& near = std::get<scene::SelectNearAvatar>(select.by);
        const Collider& collider = colliders[index_of(colliders, near.avatar)];
        add_if([&](const Vec3& x) { return collider.closest(x).signed_distance <= near.distance; });
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

} // namespace toile::scenes
