#include "collision/body/collider_pairs.h"

#include <algorithm>

#include "core/compute/parallel.h"

namespace toile::collision {

namespace {

bool is_vertex_pair(const ContactPair& pair)
{
    return pair.kind == ContactKind::kVertexFace || pair.kind == ContactKind::kVertexShape;
}

} // namespace

AdvectingCollider advecting_collider(const ContactCollider& collider)
{
    AdvectingCollider advecting_collider;
    if (collider.mesh) {
        advecting_collider.is_mesh = true;
        advecting_collider.is_moving = collider.mesh->is_moving();
    } else {
        advecting_collider.pose_t1 = collider.shape->pose();
        advecting_collider.shape_from_t0 = collider.shape->pose_t0().inverse();
    }
    return advecting_collider;
}

ColliderPairs::ColliderPairs(View<const Triangle> triangles, View<const Vec3> positions,
                             std::vector<ContactCollider> colliders, const Settings& settings)
    : colliders_(std::move(colliders)), settings_(settings), detector_(triangles, positions),
      sides_(positions.size()), found_at_(positions.begin(), positions.end()), reach_(positions.size(), 0.0),
      wanted_(positions.size(), 0.0), nearest_(positions.size())
{
}

void ColliderPairs::find(const StepStart& start, View<const Vec3> from)
{
    if (empty())
        return;
    if (from.empty())
        advect(start);
    else
        found_at_.assign(from.begin(), from.end());
    max_motion_ = kMaxAdvectionSpeed * start.dt;
    const ReachVertex reach{start.prediction, found_at_, settings_.gap};
    shape_radius_ = 0.0;
    for (int v = 0; v < start.x.size(); ++v) {
        wanted_[v] = reach_[v] = reach(v);
        shape_radius_ = std::max(shape_radius_, reach.shape_reach(v));
    }
    pairs_.clear();
    search(found_at_);
}

View<const Vec3> ColliderPairs::advect(const StepStart& start)
{
    max_motion_ = kMaxAdvectionSpeed * start.dt;
    std::vector<AdvectingCollider> colliders;
    for (const ContactCollider& collider : colliders_) {
        colliders.push_back(advecting_collider(collider));
        if (!collider.mesh)
            continue;
        colliders.back().mesh = collider.mesh->pose();
        colliders.back().motion = collider.mesh->last_motion().view();
    }
    parallel_for(kCpu, "contact/advect", start.x.size(),
                 AdvectVertex{colliders, nearest_, start.x, max_motion_, found_at_});
    return found_at_;
}

void ColliderPairs::find_again(View<const Vec3> x, View<const unsigned char> out_of_bounds)
{
    if (empty() || std::find(out_of_bounds.begin(), out_of_bounds.end(), 1) == out_of_bounds.end())
        return;
    for (int v = 0; v < x.size(); ++v) {
        wanted_[v] = kNowhere;
        if (!out_of_bounds[v])
            continue;
        found_at_[v] = x[v];
        wanted_[v] = reach_[v] = settings_.gap + kReachMargin;
    }
    std::erase_if(pairs_, [&](const ContactPair& pair) {
        if (colliders_[pair.collider].shape)
            return true;
        for (int k = 0; k < pair.count(); ++k)
            if (wanted_[pair.vertex[k]] != kNowhere)
                return true;
        return false;
    });
    search(x);
}

/// Appends the pairs of vertices with a wanted reach.
void ColliderPairs::search(View<const Vec3> x)
{
    const StageScope stage("collision/detect");
    DetectSettings settings;
    settings.radius = shape_radius_;
    settings.max_mesh_radius = kMaxReach;
    settings.max_motion = max_motion_;
    settings.face_vertex = settings_.face_vertex;
    settings.edge_edge = settings_.edge_edge;
    detector_.move(x, wanted_);
    for (int c = 0; c < int(colliders_.size()); ++c) {
        if (colliders_[c].mesh)
            detector_.detect(*colliders_[c].mesh, c, settings, pairs_, &sides_);
        else
            detector_.detect(*colliders_[c].shape, c, settings, pairs_);
    }
    take_nearest();
}

void ColliderPairs::take_nearest()
{
    std::fill(nearest_.begin(), nearest_.end(), NearestSurface{});
    for (const ContactPair& pair : pairs_)
        if (is_vertex_pair(pair))
            nearest_[pair.vertex[0]].consider(pair, found_at_);
}

bool ColliderPairs::mark_unseen(View<const Vec3> x, View<unsigned char> out_of_bounds)
{
    bool any = false;
    if (empty())
        return any;
    detector_.move(x);
    for (int c = 0; c < int(colliders_.size()); ++c) {
        if (!colliders_[c].mesh)
            continue;
        const MarkUnseen mark{detector_.clearance_of(*colliders_[c].mesh, c).bounds(),
                              x,
                              found_at_,
                              reach_,
                              settings_.gap,
                              out_of_bounds};
        for (int v = 0; v < x.size(); ++v)
            if (mark.is_unseen(v)) {
                mark(v);
                any = true;
            }
    }
    return any;
}

void ColliderPairs::update_sides(View<const Vec3> x)
{
    if (empty())
        return;
    detector_.move(x);
    for (int c = 0; c < int(colliders_.size()); ++c)
        if (const MeshCollider* mesh = colliders_[c].mesh)
            sides_.update(x, *mesh, c, detector_.clearance_of(*mesh, c));
}

void ColliderPairs::forget()
{
    std::fill(nearest_.begin(), nearest_.end(), NearestSurface{});
    sides_.forget();
}

} // namespace toile::collision
