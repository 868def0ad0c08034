#include "collision/body/detect.h"

#include "collision/body/find_pairs.h"
#include "collision/body/shape_search.h"

namespace toile::collision {

namespace {

/// True if two boxes are farther apart than `reach` [m] along an axis.
bool are_apart(const Bounds& a, const Bounds& b, double reach)
{
    return ((a.lower - b.upper).array() > reach).any() || ((b.lower - a.upper).array() > reach).any();
}

} // namespace

ContactDetector::ContactDetector(View<const Triangle> triangles, View<const Vec3> positions)
    : cloth_(triangles, positions)
{
    move(positions);
}

void ContactDetector::move(View<const Vec3> x, View<const double> reach)
{
    x_ = x;
    reach_ = reach;
    bounds_ = bounds(x);
    tree_is_stale_ = true;
}

const SurfaceProximity& ContactDetector::cloth_surface()
{
    if (tree_is_stale_) {
        const StageScope stage("collision/cloth_refit");
        cloth_.update(x_);
        tree_is_stale_ = false;
    }
    return cloth_;
}

Clearance& ContactDetector::clearance_of(const MeshCollider& mesh, int collider)
{
    while (int(clearance_.size()) <= collider)
        clearance_.emplace_back(x_.size());
    clearance_[collider].follow(x_, mesh);
    return clearance_[collider];
}

void ContactDetector::detect(const MeshCollider& mesh, int collider, const DetectSettings& settings,
                             std::vector<ContactPair>& out, const ContactSideHistory* sides)
{
    if (are_apart(bounds_, mesh.bounds(), std::max(settings.mesh_radius(), settings.max_depth)))
        return;
    const PairSearch search{x_, reach_, mesh, collider, settings, sides, clearance_of(mesh, collider)};
    find_vertex_face(search, out);
    if (settings.face_vertex)
        if (const auto vertices = find_reaching_vertices(search, cloth_.triangles()); !vertices.empty())
            find_face_vertex(search, vertices, cloth_surface(), out);
    if (settings.edge_edge)
        find_edge_edge(search, cloth_.edges(), out);
}

void ContactDetector::detect(const ShapeCollider& shape, int collider, const DetectSettings& settings,
                             std::vector<ContactPair>& out)
{
    find_vertex_shape(x_, shape, collider, settings.radius, out);

    const ShapeSkeleton skeleton = skeleton_of(shape.shape(), shape.pose());
    if (skeleton.corners.empty() ||
        are_apart(bounds_, bounds(skeleton.points()), skeleton.radius + settings.radius))
        return;
    const ShapeSearch search(cloth_, x_, shape, skeleton, collider, settings.radius);
    if (settings.face_vertex)
        search.find_faces(out);
    if (settings.edge_edge)
        search.find_edges(out);
}

} // namespace toile::collision
