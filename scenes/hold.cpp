#include "scenes/hold.h"

#include <algorithm>

#include "core/backend/error.h"

namespace toile {

namespace {

/// Least height [m] above an avatar's surface at which it carries a vertex.
constexpr double kLeastHeight = 0.0005;

/// Orthonormal frame of a triangle: first edge, in-plane normal to it, normal.
Mat3 frame_of(const TriangleMesh& mesh, int t)
{
    const Triangle& corner = mesh.triangles[t];
    const Vec3 edge = mesh.positions[corner[1]] - mesh.positions[corner[0]];
    const Vec3 normal = edge.cross(mesh.positions[corner[2]] - mesh.positions[corner[0]]);
    Mat3 frame;
    frame.col(0) = edge.normalized();
    frame.col(2) = normal.normalized();
    frame.col(1) = frame.col(2).cross(frame.col(0));
    return frame;
}

Vec3 interpolate(const TriangleMesh& mesh, int t, const Vec3& barycentric)
{
    const Triangle& corner = mesh.triangles[t];
    return barycentric[0] * mesh.positions[corner[0]] + barycentric[1] * mesh.positions[corner[1]] +
           barycentric[2] * mesh.positions[corner[2]];
}

int nearest_vertex(View<const Vec3> x, const Vec3& point)
{
    int best = 0;
    for (int v = 1; v < x.size(); ++v)
        if ((x[v] - point).squaredNorm() < (x[best] - point).squaredNorm())
            best = v;
    return best;
}

double distance_to(const Obstacle& obstacle, const Vec3& x)
{
    const ContactPartner partner = obstacle.partner();
    if (partner.shape)
        return partner.shape->closest(x).signed_distance;
    return partner.mesh->surface().closest(x)->signed_distance;
}

int index_of(const std::vector<Obstacle>& obstacles, const std::string& name)
{
    const auto found = std::find_if(obstacles.begin(), obstacles.end(),
                                    [&](const Obstacle& obstacle) { return obstacle.name() == name; });
    return found == obstacles.end() ? -1 : int(found - obstacles.begin());
}

} // namespace

Hold::Hold(const scene::Attachment& settings, View<const Vec3> start, const std::vector<Obstacle>& obstacles,
           const std::string& place)
    : settings_(settings), motion_(settings.keyframes, Vec3::Zero())
{
    select(start, obstacles, place);
    if (vertices_.empty())
        throw InvalidInput(place + ": selects no vertex of \"" + settings.cloth +
                           "\"; move the selection to where the cloth starts");
    for (const int v : vertices_)
        start_.push_back(start[v]);
    if (settings.to != scene::kFixed) {
        obstacle_ = index_of(obstacles, settings.to);
        tie(obstacles[obstacle_]);
    }
}

void Hold::select(View<const Vec3> start, const std::vector<Obstacle>& obstacles, const std::string& place)
{
    if (const auto* indices = std::get_if<std::vector<int>>(&settings_.select.by)) {
        for (const int v : *indices)
            if (v < 0 || v >= start.size())
                throw InvalidInput(place + ": vertex " + std::to_string(v) + " is out of range; \"" +
                                   settings_.cloth + "\" has vertices 0 to " +
                                   std::to_string(start.size() - 1));
        vertices_ = *indices;
    } else if (const auto* points = std::get_if<std::vector<Vec3>>(&settings_.select.by)) {
        for (const Vec3& point : *points)
            vertices_.push_back(nearest_vertex(start, point));
    } else if (const auto* box = std::get_if<scene::SelectBox>(&settings_.select.by)) {
        for (int v = 0; v < start.size(); ++v)
            if ((start[v].array() >= box->lower.array()).all() &&
                (start[v].array() <= box->upper.array()).all())
                vertices_.push_back(v);
    } else {
        const auto& near = std::get<scene::SelectNearAvatar>(settings_.select.by);
        const Obstacle& obstacle = obstacles[index_of(obstacles, near.avatar)];
        for (int v = 0; v < start.size(); ++v)
            if (distance_to(obstacle, start[v]) <= near.distance)
                vertices_.push_back(v);
    }
    std::sort(vertices_.begin(), vertices_.end());
    vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
}

void Hold::tie(const Obstacle& obstacle)
{
    shape_from_world_ = obstacle.body().pose().inverse();
    if (obstacle.partner().shape)
        return;
    for (const Vec3& x : start_) {
        const SurfacePoint at = *obstacle.partner().mesh->surface().closest(x);
        const Mat3 frame = frame_of(obstacle.body().contact_surface(), at.triangle);
        Vec3 offset = frame.transpose() * (x - at.point);
        if (at.signed_distance < kLeastHeight) // starts inside: held on the skin, not under it
            offset = kLeastHeight * Vec3::UnitZ();
        ties_.push_back({at.triangle, at.barycentric, offset});
    }
}

Vec3 Hold::target(int k, double t, const std::vector<Obstacle>& obstacles) const
{
    if (obstacle_ < 0)
        return motion_.at(t) * start_[k];
    const SceneBody& body = obstacles[obstacle_].body();
    if (ties_.empty())
        return body.pose() * (shape_from_world_ * start_[k]);
    const SurfaceTie& tie = ties_[k];
    return interpolate(body.contact_surface(), tie.triangle, tie.barycentric) +
           frame_of(body.contact_surface(), tie.triangle) * tie.offset;
}

} // namespace toile
