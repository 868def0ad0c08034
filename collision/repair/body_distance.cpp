#include "collision/repair/body_distance.h"

namespace toile::collision {

namespace {

bool is_on_border(const SurfaceProximity& surface, const SurfacePoint& at)
{
    const SurfaceEdges& edges = surface.edges();
    const auto is_border = [&](int edge) { return edges.triangles.of(edge).size() == 1; };
    if (const int k = edge_of(at.feature); k >= 0)
        return is_border(edges.triangle_edge[at.triangle][k]);
    const int k = vertex_of(at.feature);
    if (k < 0)
        return false;
    for (const int corner : edges.corners_of_vertex.of(surface.triangles()[at.triangle][k])) {
        const std::array<int, 3>& sides = edges.triangle_edge[corner / 3];
        if (is_border(sides[corner % 3]) || is_border(sides[(corner + 2) % 3]))
            return true;
    }
    return false;
}

std::optional<BodyProximity> proximity_to(const ContactCollider& body, const Vec3& p, double reach)
{
    BodyProximity proximity;
    if (body.shape != nullptr) {
        const ShapePoint at = body.shape->closest(p);
        proximity.signed_distance = at.signed_distance;
        proximity.normal = at.normal;
        return proximity;
    }
    const Bounds& box = body.mesh->bounds();
    if (((box.lower - p).array() > reach).any() || ((p - box.upper).array() > reach).any())
        return std::nullopt;
    const std::optional<SurfacePoint> at = body.mesh->surface().closest(p, std::max(reach, kMaxStartDepth));
    if (!at || (at->signed_distance < 0.0 && is_on_border(body.mesh->surface(), *at)))
        return std::nullopt;
    proximity.signed_distance = at->signed_distance;
    proximity.normal = at->normal;
    return proximity;
}

} // namespace

std::optional<BodyProximity> nearest_body(const std::vector<ContactCollider>& bodies, const Vec3& p,
                                          double reach)
{
    std::optional<BodyProximity> nearest;
    for (size_t b = 0; b < bodies.size(); ++b) {
        std::optional<BodyProximity> proximity = proximity_to(bodies[b], p, reach);
        if (!proximity || proximity->signed_distance > reach)
            continue;
        proximity->body = int(b);
        if (!nearest || proximity->signed_distance < nearest->signed_distance)
            nearest = proximity;
    }
    return nearest;
}

} // namespace toile::collision
