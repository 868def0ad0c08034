#include "collision/body/find_pairs.h"

namespace toile::collision {

namespace {

/// Appends the pairs of one cloth vertex.
/// @param hint  last triangle found, passed from vertex to vertex for those without an earlier result
void find_planes(const PairSearch& search, int v, int& hint, std::vector<ContactPair>& out)
{
    const MeshCollider& mesh = search.mesh;
    const Vec3& x = search.x[v];
    const MeshPose pose = mesh.pose();
    const auto add = [&](const SurfacePoint& at) {
        out.push_back(vertex_face_pair(pose, search.collider, v, x, at));
    };

    // Closest point: in front within the radius, behind down to the maximum depth.
    const double radius = search.radius_of(v);
    const double reach = std::max(radius, search.settings.max_depth);
    const int last = search.clearance.nearest(v);
    const std::optional<SurfacePoint> nearest = mesh.surface().closest(x, reach, last >= 0 ? last : hint);
    search.clearance.record(v, nearest ? std::max(nearest->signed_distance, 0.0) : reach,
                            nearest ? nearest->triangle : -1);
    if (!nearest)
        return;
    hint = nearest->triangle;
    thread_local std::vector<SurfacePoint> sheets;
    sheets.clear();
    if (search.sides != nullptr && nearest->signed_distance < 0.0)
        search.sides->find_behind(v, x, mesh, search.collider, search.settings.max_motion, sheets);
    VertexPlanes planes(x, radius, search.settings.max_depth);
    planes.take_first(*nearest, sheets, add);
    if (planes.count == 0)
        return;

    // Other sheets that the vertex is in front of, each distinct from the earlier ones.
    mesh.surface().local_closest(x, radius, sheets, planes.normal[0]);
    for (const SurfacePoint& sheet : sheets)
        if (!planes.is_full() && planes.is_wanted(sheet))
            planes.take(sheet, add);
}

} // namespace

void find_vertex_face(const PairSearch& search, std::vector<ContactPair>& out)
{
    const double reach = std::max(search.settings.mesh_radius(), search.settings.max_depth);
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

} // namespace toile::collision
