#include "collision/untangle/body_distance.h"

namespace toile {

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

std::optional<BodyPlace> place_at(const ContactPartner& body, const Vec3& p, double reach)
{
    BodyPlace place;
    if (body.shape != nullptr) {
        const ShapePoint at = body.shape->closest(p);
        place.signed_distance = at.signed_distance;
        place.normal = at.normal;
        return place;
    }
    const Bounds& box = body.mesh->bounds();
    if (((box.lower - p).array() > reach).any() || ((p - box.upper).array() > reach).any())
        return std::nullopt;
    const std::optional<SurfacePoint> at = body.mesh->surface().closest(p, std::max(reach, kMaxStartDepth));
    if (!at || (at->signed_distance < 0.0 && is_on_border(body.mesh->surface(), *at)))
        return std::nullopt;
    place.signed_distance = at->signed_distance;
    place.normal = at->normal;
    return place;
}

} // namespace

std::optional<BodyPlace> nearest_body(const std::vector<ContactPartner>& bodies, const Vec3& p, double reach)
{
    std::optional<BodyPlace> nearest;
    for (size_t b = 0; b < bodies.size(); ++b) {
        std::optional<BodyPlace> place = place_at(bodies[b], p, reach);
        if (!place || place->signed_distance > reach)
            continue;
        place->body = int(b);
        if (!nearest || place->signed_distance < nearest->signed_distance)
            nearest = place;
    }
    return nearest;
}

} // namespace toile
