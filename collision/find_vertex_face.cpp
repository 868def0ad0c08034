#include "collision/find_pairs.h"

namespace toile {

namespace {

/// Planes per cloth vertex: a corner needs three, more would only repeat them.
constexpr size_t kMaxPlanes = 3;

/// Gradient of the signed distance: the direction between vertex and surface, turned outwards.
Vec3 outward(const SurfacePoint& surface, const Vec3& x)
{
    return surface.distance() > kTouching ? Vec3((x - surface.point) / surface.signed_distance)
                                          : surface.normal;
}

/// The pairs of one cloth vertex. `hint` carries the last triangle found from vertex to vertex, for those
/// that have not been looked for yet.
void find_planes(const PairSearch& search, int v, int& hint, std::vector<ContactPair>& out)
{
    const MeshCollider& mesh = search.mesh;
    const Vec3& x = search.x[v];
    const auto add = [&](const SurfacePoint& at) {
        out.push_back({.vertex = contact_vertices(v),
                       .weight = {1.0},
                       .normal = outward(at, x),
                       .point = at.point,
                       .motion = mesh.motion(at.triangle, at.barycentric),
                       .collider = search.collider,
                       .kind = ContactKind::kVertexFace,
                       .feature = at.triangle});
    };

    const size_t first = out.size();
    const auto is_distinct = [&](const Vec3& n) {
        return std::all_of(out.begin() + long(first), out.end(),
                           [&](const ContactPair& kept) { return kept.normal.dot(n) < kDistinctCosine; });
    };

    // The closest point: in front within the radius, behind down to the depth.
    const double radius = search.radius_of(v);
    const double reach = std::max(radius, search.settings.max_depth);
    const int last = search.clearance.nearest(v);
    const std::optional<SurfacePoint> nearest = mesh.surface().closest(x, reach, last >= 0 ? last : hint);
    search.clearance.learn(v, nearest ? std::max(nearest->signed_distance, 0.0) : reach,
                           nearest ? nearest->triangle : -1);
    if (!nearest)
        return;
    hint = nearest->triangle;
    thread_local std::vector<SurfacePoint> sheets;
    sheets.clear();
    const bool is_behind = nearest->signed_distance < 0.0;
    if (search.sides != nullptr && is_behind)
        search.sides->find_behind(v, x, mesh, search.collider, search.settings.farthest_motion, sheets);
    const bool is_caught = !sheets.empty();
    if (is_behind ? !is_caught && nearest->distance() < search.settings.max_depth
                  : nearest->distance() < radius)
        add(*nearest);

    // Sheets that it has come behind, of a body that it is inside of: outside, the place on a remembered
    // sheet may face away from cloth that has gone round it.
    for (const SurfacePoint& sheet : sheets)
        if (out.size() - first < kMaxPlanes && is_distinct(outward(sheet, x)))
            add(sheet);
    if (out.size() == first)
        return;

    // Other sheets that the vertex stands in front of, each turned away from those before.
    mesh.surface().local_closest(x, radius, sheets, out[first].normal);
    for (const SurfacePoint& sheet : sheets) {
        if (out.size() - first == kMaxPlanes)
            break;
        if (sheet.signed_distance >= 0.0 && sheet.distance() < radius && is_distinct(outward(sheet, x)))
            add(sheet);
    }
}

} // namespace

void find_vertex_face(const PairSearch& search, std::vector<ContactPair>& out)
{
    const double reach = std::max(search.settings.radius, search.settings.max_depth);
    parallel_append(
        kCpu, "collision/vertex_face", search.x.size(),
        [&](int begin, int end, std::vector<ContactPair>& pairs) {
            int hint = -1;
            for (int v = begin; v < end; ++v)
                if (search.clearance.of(v) <= search.radius_of(v) &&
                    is_near(search.mesh.bounds(), search.x[v], reach))
                    find_planes(search, v, hint, pairs);
        },
        out);
}

} // namespace toile
