#include "collision/colliders.h"

#include <algorithm>
#include <limits>

#include "core/backend/parallel.h"

namespace toile {

namespace {

/// cos of the angle between face normals [-] above which an edge counts as flat: 1 degree.
constexpr double kRidgeCosine = 0.99984769515639;

} // namespace

MeshCollider::MeshCollider(const MovingMesh& mesh)
    : surface_(mesh.triangles, mesh.x_t1), x_t0_(mesh.x_t0), first_owned_(mesh.triangles.size() + 1, 0),
      bounds_(toile::bounds(mesh.x_t1))
{
    // Edges by their lowest triangle.
    const SurfaceEdges& edges = surface_.edges();
    for (int e = 0; e < edges.edge_count(); ++e)
        ++first_owned_[edges.triangles.of(e)[0] + 1];
    for (size_t t = 1; t < first_owned_.size(); ++t)
        first_owned_[t] += first_owned_[t - 1];
    owned_edges_.resize(edges.vertex.size());
    std::vector<int> next(first_owned_.begin(), first_owned_.end() - 1);
    for (int e = 0; e < edges.edge_count(); ++e)
        owned_edges_[next[edges.triangles.of(e)[0]]++] = {e, edges.vertex[e]};
}

void MeshCollider::move(const MovingMesh& mesh)
{
    TOILE_ASSERT(int(mesh.x_t1.size()) == surface_.positions().size());
    x_t0_ = mesh.x_t0;
    is_moving_ = !std::equal(mesh.x_t1.begin(), mesh.x_t1.end(), surface_.positions().begin());
    if (!is_moving_)
        return;
    const StageScope stage("collision/refit");
    ++move_count_;
    bounds_ = toile::bounds(mesh.x_t1);
    last_motion_.build(surface_.triangles(), surface_.positions(), mesh.x_t1, bounds_);
    surface_.update(mesh.x_t1);
}

Vec3 MeshCollider::motion(int triangle, const Vec3& barycentric) const
{
    const Triangle& corner = surface_.triangles()[triangle];
    return barycentric[0] * motion(corner[0]) + barycentric[1] * motion(corner[1]) +
           barycentric[2] * motion(corner[2]);
}

bool MeshCollider::is_ridge(int edge) const
{
    const View<const int> sides = surface_.edges().triangles.of(edge);
    if (sides.size() != 2)
        return true;
    const Vec3 n0 = surface_.face_normal(sides[0]);
    if (n0.dot(surface_.face_normal(sides[1])) > kRidgeCosine)
        return false;

    // Ridge: the other face's third corner lies below this face.
    const Vec3& on_edge = surface_.positions()[surface_.edges().vertex[edge][0]];
    double highest = -std::numeric_limits<double>::infinity();
    for (const int v : surface_.triangles()[sides[1]])
        if (v != surface_.edges().vertex[edge][0] && v != surface_.edges().vertex[edge][1])
            highest = std::max(highest, n0.dot(surface_.positions()[v] - on_edge));
    return highest < 0.0;
}

ShapeCollider::ShapeCollider(const Shape& shape, const Eigen::Isometry3d& pose, const std::string& source)
    : shape_(shape), pose_t0_(pose), pose_t1_(pose)
{
    require_usable(shape, source);
}

void ShapeCollider::move(const Eigen::Isometry3d& pose_t0, const Eigen::Isometry3d& pose_t1)
{
    pose_t0_ = pose_t0;
    pose_t1_ = pose_t1;
}

} // namespace toile
