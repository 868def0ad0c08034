#include "collision/detect.h"

#include "collision/find_pairs.h"

namespace toile {

ContactDetector::ContactDetector(View<const Triangle> triangles, View<const Vec3> positions)
    : cloth_(triangles, positions)
{
    move(positions);
}

void ContactDetector::move(View<const Vec3> x)
{
    x_ = x;
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

void ContactDetector::detect(const MeshCollider& mesh, int collider, const DetectSettings& settings,
                             std::vector<ContactPair>& out)
{
    // Nothing to do where the boxes are farther apart than any pair may be.
    const double reach = std::max(settings.radius, settings.max_depth);
    const Bounds& other = mesh.bounds();
    if (((bounds_.lower - other.upper).array() > reach).any() ||
        ((other.lower - bounds_.upper).array() > reach).any())
        return;

    const PairSearch search{x_, bounds_, mesh, collider, settings};
    find_vertex_face(search, out);
    if (settings.face_vertex)
        find_face_vertex(search, cloth_surface(), out);
    if (settings.edge_edge)
        find_edge_edge(search, cloth_.edges(), out);
}

void ContactDetector::detect(const ShapeCollider& shape, int collider, const DetectSettings& settings,
                             std::vector<ContactPair>& out)
{
    parallel_append(
        kCpu, "collision/shape", x_.size(),
        [&](int begin, int end, std::vector<ContactPair>& pairs) {
            for (int v = begin; v < end; ++v) {
                const ShapePoint at = shape.closest(x_[v]);
                if (at.signed_distance < settings.radius)
                    pairs.push_back({.vertex = {v, -1, -1},
                                     .weight = {1.0, 0.0, 0.0},
                                     .normal = at.normal,
                                     .point = at.point,
                                     .motion = shape.motion(at.point),
                                     .collider = collider,
                                     .kind = ContactKind::kVertexShape,
                                     .feature = 0});
            }
        },
        out);
}

} // namespace toile
